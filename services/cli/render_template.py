"""Fills a Jinja template with a summary.json: what `dispersa report DIR --template FILE` runs. The text goes to standard
output; what is wrong with the template too, as "file:line: what", with exit code 2. Exit code 77: no jinja2 here.

usage: render_template.py SUMMARY TEMPLATE
"""
import json
import math
import pathlib
import signal
import sys
import traceback

try:
    import jinja2
    import jinja2.sandbox
except ImportError:
    sys.exit(77)

# A template that loops for ever is ended.
PATIENCE_S = 120


def number(value, digits=5):
    """As the reports write numbers: so many significant digits, no exponent between 1e-4 and 1e9."""
    if value is None or not math.isfinite(value):
        return "\u2013"
    if value == 0:
        return "0"
    if isinstance(value, int):
        return str(value)
    if not 1e-4 <= abs(value) < 1e9:
        return f"{value:.{max(0, digits - 2)}e}"
    text = f"{value:.{min(max(digits - 1 - math.floor(math.log10(abs(value))), 0), 7)}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def percent(value):
    """A probability in per cent, never rounded to 100."""
    if value is None:
        return "\u2013"
    text = f"{100 * value:.5g}"
    return (f"{100 * value:.9g}" if text == "100" and value < 1 else text) + " %"


def place(error, template):
    """The line of the template in which an error arose; jinja rewrites the frames of its templates."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(template)]
    return f"{template}:{frames[-1].lineno}" if frames else str(template)


def fail(text):
    sys.stdout.write(text + "\n")
    sys.exit(2)


def main(summary_file, template_file):
    template_file = pathlib.Path(template_file)
    environment = jinja2.sandbox.SandboxedEnvironment(
        loader=jinja2.FileSystemLoader(template_file.parent), undefined=jinja2.StrictUndefined, keep_trailing_newline=True,
        trim_blocks=True, lstrip_blocks=True,
        autoescape=template_file.suffix in (".html", ".htm", ".xml"))
    environment.filters.update(number=number, percent=percent)
    summary = json.loads(pathlib.Path(summary_file).read_text(encoding="utf-8"))
    # What stands after earlier attempts and changes is not the summary's to say.
    execution = pathlib.Path(summary_file).parent / "execution.json"
    told = json.loads(execution.read_text(encoding="utf-8")) if execution.is_file() else {}
    standing = {"verdict": told.get("standing_verdict") or summary["verdict"], "attempts": told.get("attempts", []),
                "requirements": [], "notes": [], "post_hoc": False} | told.get("standing", {})
    for k, requirement in enumerate(summary["requirements"]):
        known = standing["requirements"][k] if k < len(standing["requirements"]) else {"verdict": requirement["verdict"]}
        requirement["standing_verdict"] = known["verdict"]
        if known.get("reason") and not known["post_hoc"]:  # what decided in place of the campaign's own flights
            requirement["sentence"] = known["reason"] + " " + requirement["sentence"]

    def too_long(*_):
        raise TimeoutError(f"takes longer than {PATIENCE_S} s")

    signal.signal(signal.SIGALRM, too_long)
    signal.alarm(PATIENCE_S)
    try:
        template = environment.get_template(template_file.name)
        text = template.render(summary, summary=summary, standing=standing)
    except jinja2.TemplateSyntaxError as error:
        fail(f"{error.filename or template_file}:{error.lineno}: {error.message}")
    except jinja2.TemplateNotFound as error:
        fail(f"{place(error, template_file)}: no template named '{error.name}' beside it")
    except UnicodeDecodeError:
        fail(f"{template_file}: is not UTF-8")
    except Exception as error:  # whatever a template does with its values
        fail(f"{place(error, template_file)}: {error}")
    sys.stdout.buffer.write(text.encode("utf-8"))


main(*sys.argv[1:])
