"""Builds the docs site: the pages beside this file, the README.md files beside the code, the Python tutorial, and what
the programs say of themselves.

    build.py --programs BIN --out SITE [--tables PROGRAM] [--package FOLDER] [--python PROGRAM]

The README files keep their folders, so that their links to one another hold; a link to anything else of the repository
becomes plain text. A page has `<!-- table: NAME -->` where a table comes: NAME is one that the program docs_tables knows
(tables.cc) or a CSV file of the repository. `<!-- changes -->` takes the snippets of changes/. Everything is read from
the repository, nothing from the network, and the pages ask for nothing.
"""
import argparse
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
sys.path.insert(0, str(REPOSITORY / "services" / "python" / "tutorial"))
from cells import cells  # noqa: E402

LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^)\s]+)\)")
TABLE = re.compile(r"<!-- table: (.+?) -->")
CHANGES = "<!-- changes -->"
# Nothing here draws it: that would be a script from elsewhere.
DIAGRAM = "\n*A diagram, as the text that Mermaid draws it from:*\n\n```text\n"


def help_of(program, *command):
    done = subprocess.run([program, *command, "--help"], capture_output=True, text=True, timeout=60,
                          env={**os.environ, "NO_COLOR": "1"})
    if done.returncode != 0:
        raise SystemExit(f"{program} {' '.join(command)} --help: {done.stderr}")
    return done.stdout.strip()


def subcommands(text):
    """The names under the heading of a help text that lists them."""
    part = re.split(r"(?im)^subcommands:\s*$", text)
    return re.findall(r"(?m)^  ([a-z]+)(?=\s)", part[1].split("\n\n")[0]) if len(part) > 1 else []


def commands_page(programs):
    page = ["# Commands", "", "The help text of every program and command.", ""]
    for name in ("dispersa", "dispersa-coordinator", "dispersa-worker"):
        text = help_of(programs / name)
        page += [f"## {name}", "", "```text", text, "```", ""]
        for command in subcommands(text):
            of_command = help_of(programs / name, command)
            page += [f"### {name} {command}", "", "```text", of_command, "```", ""]
            for part in subcommands(of_command):
                page += [f"#### {name} {command} {part}", "", "```text", help_of(programs / name, command, part), "```", ""]
    return "\n".join(page)


def changes():
    """The snippets of changes since the last release, one after the other."""
    return "\n\n".join(path.read_text().strip() for path in sorted((HERE / "changes").glob("*.md"))) or "None."


def csv_table(path):
    """A CSV file as a table."""
    with open(path, newline="") as file:
        head, *rows = csv.reader(file)
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in line)} |\n" for line in lines)


def fill_tables(folder, program):
    """Every mark of a table in the pages of a folder becomes the table."""
    pages = {path: path.read_text() for path in folder.rglob("*.md")}
    names = list(dict.fromkeys(name for text in pages.values() for name in TABLE.findall(text)))
    tables = {name: csv_table(REPOSITORY / name) for name in names if name.endswith(".csv")}
    done = subprocess.run([program, *(name for name in names if name not in tables)], capture_output=True, text=True, timeout=60)
    if done.returncode != 0:
        raise SystemExit(done.stderr)
    tables.update(json.loads(done.stdout))
    for path, text in pages.items():
        path.write_text(TABLE.sub(lambda match: tables[match[1]].rstrip("\n"), text))


def schemas_page(programs, folder):
    subprocess.run([programs / "dispersa", "--quiet", "schema", "--all", folder / "schemas"], check=True, timeout=600)
    files = "\n".join(f"| {path.stem} | [schemas/{path.name}](schemas/{path.name}) |"
                      for path in sorted((folder / "schemas").glob("*.json")))
    return (HERE / "pages" / "schemas.md").read_text().replace("@FILES@", files)


def python_page(package, python):
    """Of the package in this folder; a build may have none."""
    if package is None or not (package / "dispersa" / "__init__.py").exists():
        return ("# Reference of the Python package\n\nThese pages come from a build without the Python package. To have the "
                "reference here, install pybind11-dev and python3-dev, and build again. `help(dispersa)` shows the same.\n")
    done = subprocess.run([python, "-B", HERE / "python_reference.py"], capture_output=True, text=True, timeout=120,
                          env={**os.environ, "PYTHONPATH": str(package), "MPLBACKEND": "Agg"})
    if done.returncode != 0:
        raise SystemExit(f"python_reference.py: {done.stderr}")
    return done.stdout


def linked(text, source, known):
    """The text of `source` (a path in the repository) with links that the site can follow."""
    def replace(match):
        picture, words, target = match.groups()
        path, _, anchor = target.partition("#")
        if re.match(r"[a-z]+:", target) or not path:
            return match.group(0)
        found = os.path.normpath(os.path.join(source.parent, path))
        if found in known or picture:
            return match.group(0)
        page = os.path.basename(found)
        if found == f"services/docs/pages/{page}" and page in known:
            return f"[{words}]({os.path.relpath(page, source.parent)}{'#' + anchor if anchor else ''})"
        if found.endswith(".py") and found[:-3] + ".md" in known:
            return f"[{words}]({path[:-3]}.md)"
        if found == "README.md":
            return f"{picture}[{words}]({os.path.relpath('index.md', source.parent)}{'#' + anchor if anchor else ''})"
        if os.path.join(found, "README.md") in known:
            return f"[{words}]({os.path.join(path, 'README.md')})"
        return words
    # Code is no link.
    parts = re.split(r"(```.*?```|`[^`\n]*`)", text, flags=re.S)
    return "".join(part if i % 2 else LINK.sub(replace, part) for i, part in enumerate(parts))


def cells_page(script):
    """A Python script of cells (`# %%`) as a page: text cells as they are, the others as code."""
    return "\n\n".join(body if is_text else f"```python\n{body}\n```" for is_text, body in cells(script)) + "\n"


def collect(programs, folder, python_reference):
    """All sources of the site in one folder."""
    listed = re.findall(r"([\w/.-]+\.md)\s*$", (HERE / "mkdocs.yml").read_text(), re.M)
    known = set(listed) | {path.name for path in (HERE / "pages").glob("*.md")}
    for name in listed:
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if name == "commands.md":
            text = commands_page(programs)
        elif name == "schemas.md":
            text = schemas_page(programs, folder)
        elif name == "services/python/reference.md":
            text = python_reference
        elif (HERE / "pages" / name).exists():
            text = (HERE / "pages" / name).read_text().replace(CHANGES, changes())
        else:
            source = REPOSITORY / name
            text = source.read_text() if source.exists() else cells_page(source.with_suffix(".py").read_text())
            text = linked(text.replace("\n```mermaid\n", DIAGRAM), pathlib.PurePosixPath(name), known)
            for picture, _, link in LINK.findall(text):
                if picture:
                    place = folder / os.path.normpath(os.path.join(os.path.dirname(name), link))
                    place.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copy(source.parent / link, place)
        target.write_text(text)
    shutil.copytree(HERE / "pages" / "images", folder / "images", dirs_exist_ok=True)
    shutil.copy(HERE / "pages" / "site.css", folder / "site.css")


def search_from_a_folder(site):
    """Pages that are opened from a folder may not ask for files, which is how the theme's search gets its index and its
    worker; for them both are in a script."""
    worker, = (site / "assets" / "javascripts" / "workers").glob("search.*.min.js")
    index = json.loads((site / "search" / "search_index.json").read_text())
    (site / "search" / "offline.js").write_text(
        f"var __search = {{index: Promise.resolve({json.dumps(index)}),\n"
        f"  worker: URL.createObjectURL(new Blob([{json.dumps(worker.read_text())}], {{type: 'text/javascript'}}))}};\n")
    for page in site.rglob("*.html"):
        text = page.read_text()
        bundle = re.search(r'<script src="([^"]*)assets/javascripts/bundle\.', text)
        loader = (f"<script>location.protocol === 'file:' && "
                  f"document.write('<script src=\"{bundle[1]}search/offline.js\"><\\/script>')</script>")
        page.write_text(text[:bundle.start()] + loader + text[bundle.start():])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--programs", type=pathlib.Path, required=True, help="folder of the built programs")
    parser.add_argument("--tables", type=pathlib.Path, help="the program docs_tables; else that of the same build")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder of the site")
    parser.add_argument("--package", type=pathlib.Path, help="folder with the built Python package, if there is one")
    parser.add_argument("--python", default="/usr/bin/python3", help="the Python for which it is built")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="dispersa-docs-") as name:
        folder = pathlib.Path(name)
        (folder / "docs").mkdir()
        package = options.package.resolve() if options.package else None
        collect(options.programs.resolve(), folder / "docs", python_page(package, options.python))
        fill_tables(folder / "docs", (options.tables or options.programs.parent / "tools" / "docs_tables").resolve())
        config = (HERE / "mkdocs.yml").read_text()
        (folder / "mkdocs.yml").write_text(f"docs_dir: {folder}/docs\nsite_dir: {folder}/site\n" + config)
        done = subprocess.run(["/usr/bin/python3", "-m", "mkdocs", "build", "--strict", "--quiet", "-f", folder / "mkdocs.yml"],
                              capture_output=True, text=True, timeout=600)
        if done.returncode != 0:
            sys.stderr.write(done.stdout + done.stderr)
            return 1
        (folder / "site" / "404.html").unlink()  # a server's, with links from its root
        search_from_a_folder(folder / "site")
        shutil.rmtree(options.out, ignore_errors=True)
        options.out.parent.mkdir(parents=True, exist_ok=True)
        shutil.copytree(folder / "site", options.out)
    print(f"docs: {options.out / 'index.html'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
