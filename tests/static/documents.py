"""Counts the long sentences of every Markdown page against recorded counts, which may only fall, and checks the form of
CHANGELOG.md.

    documents.py REPOSITORY             lists the violations
    documents.py REPOSITORY --record    writes lower counts into long_sentences.csv; those of new pages too, if 0

A sentence is long with more than 25 words. Code, tables, headings, addresses and generated parts do not count.
"""
import csv
import pathlib
import re
import sys

from hygiene import tracked_files

LONGEST = 25
COUNTS = "tests/static/long_sentences.csv"
RELEASE = re.compile(r"\d+\.\d+\.\d+, \d{4}-\d{2}-\d{2}")
LINES_OF_A_RELEASE = 30


def sentences(text):
    """The sentences of a page, as lists of words. A list's item is a paragraph of its own."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    text = re.sub(r"^(\||#|!\[).*$", "", text, flags=re.M)
    text = re.sub(r"`[^`]*`", "code", text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    for paragraph in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", text):
        paragraph = re.sub(r"^\s*(?:[-*]|\d+\.) ", "", paragraph)
        for sentence in re.split(r"(?<=[.!?])[)\"*]*\s+", paragraph):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if words:
                yield words


def count(text):
    return sum(len(words) > LONGEST for words in sentences(text))


def counts_of(root):
    """{page: number of long sentences} of the pages under version control."""
    pages = [path for path in tracked_files(root) if path.suffix == ".md" and not str(path).startswith("tests/data/")]
    return {str(path): count((root / path).read_text()) for path in sorted(pages) if (root / path).exists()}


def changelog_problems(text):
    found = []
    for section in text.split("\n## ")[1:]:
        title, _, body = section.partition("\n")
        if not RELEASE.fullmatch(title):
            found.append(f"CHANGELOG.md: '{title}' is no release: 'VERSION, YEAR-MONTH-DAY'; other changes are snippets")
        lines = len(body.strip().splitlines())
        if lines > LINES_OF_A_RELEASE:
            found.append(f"CHANGELOG.md: {title} has {lines} lines, allowed: {LINES_OF_A_RELEASE}")
    return found


def recorded(root):
    with open(root / COUNTS, newline="") as file:
        return {row["page"]: int(row["long_sentences"]) for row in csv.DictReader(file)}


def check(root):
    """The violations as lines of text."""
    allowed = recorded(root)
    found = []
    for page, number in counts_of(root).items():
        most = allowed.get(page, 0)
        if number > most:
            found.append(f"{page}: {number} sentences of more than {LONGEST} words, allowed: {most}")
    return found + changelog_problems((root / "CHANGELOG.md").read_text())


def record(root):
    allowed = recorded(root)
    lower = {page: min(number, allowed.get(page, 0)) for page, number in counts_of(root).items()}
    rows = [f"{page},{number}\n" for page, number in sorted(lower.items()) if number > 0]
    (root / COUNTS).write_text("page,long_sentences\n" + "".join(rows))


if __name__ == "__main__":
    repository = pathlib.Path(sys.argv[1])
    if "--record" in sys.argv:
        record(repository)
    violations = check(repository)
    print("\n".join(violations))
    sys.exit(1 if violations else 0)
