"""Makes the picture of a report that README.md and the docs site show, and the list of the parts that it shows.

    picture.py DISPERSA

flies the campaign table3 with this program and writes images/table3_report.png and .txt beside the pages. It needs
chromium (`apt-get install chromium`). A test compares the list with today's report (tests/docs/picture_test.py).
"""
import html
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
CAMPAIGN = HERE.parent.parent / "campaigns" / "table3.yaml"
PARTS = HERE / "pages" / "images" / "table3_report.txt"
WIDTH, HEIGHT = 1140, 940


def parts(report):
    """The parts of a report up to its second section, one a line: title, columns, links, labels."""
    head = "<h2".join(report[report.index("<body>"):].split("<h2", 2)[:2])
    found = re.findall(r"<(h1|h2|th(?= scope=\"col\")|nav|dt)\b[^>]*>(.*?)</(?:h1|h2|th|nav|dt)>", head, re.S)
    lines = []
    for kind, text in found:
        for piece in re.findall(r"<a [^>]*>(.*?)</a>", text) if kind == "nav" else [text]:
            words = html.unescape(re.sub(r"<[^>]*>", "", piece)).strip()
            line = f"{kind}: {words}"
            if line not in lines:
                lines.append(line)
    return "\n".join(lines) + "\n"


def fly(dispersa, folder, *options):
    """A report of the campaign, as text."""
    out = pathlib.Path(folder) / "results"
    done = subprocess.run([dispersa, "run", CAMPAIGN, "--workers", "0", "--quiet", "--out", out, *options],
                          capture_output=True, text=True, timeout=900)
    if not (out / "report.html").exists():
        raise SystemExit(done.stderr)
    return (out / "report.html").read_text()


def main():
    with tempfile.TemporaryDirectory(prefix="dispersa-picture-") as folder:
        report = fly(sys.argv[1], folder)
        page = pathlib.Path(folder) / "page.html"
        page.write_text(re.sub(r" · (by [^·<]+ on|in) [^·<]+?(?= ·)", "", report))  # who made the picture, and how fast
        subprocess.run(["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                        f"--window-size={WIDTH},{HEIGHT}", f"--screenshot={PARTS.with_suffix('.png')}", page.as_uri()],
                       check=True, capture_output=True, timeout=120)
        PARTS.write_text(parts(report))
    print(f"picture: {PARTS.with_suffix('.png')}")


if __name__ == "__main__":
    main()
