"""Checks the repository's text files: no path of somebody's machine, no unfinished or conflict markers, final
newline, valid UTF-8, and shell scripts that parse.

usage: hygiene.py REPOSITORY
"""
import pathlib
import re
import subprocess
import sys

# Written in pieces so that this file passes its own check.
FORBIDDEN = [
    (re.compile(r"(?<![\w.$}])/" + r"(home|root|Users|mnt|work)/\w"), "path of one machine"),
    (re.compile(r"\b(TO" + r"DO|FIX" + r"ME|XX" + r"X|HA" + r"CK)\b"), "unfinished marker"),
    (re.compile(r"^(<{7}|>{7}|\|{7}) "), "conflict marker"),
    (re.compile(r"\r$"), "carriage return"),
    (re.compile(r"[ \t]+$"), "trailing white space"),
]
BINARY = {".png", ".jpg", ".webp", ".ico", ".woff2", ".gz", ".sqlite"}
# Files of others, kept as they came.
FOREIGN = re.compile(r"LICENSE|tests/data/.*|.*\.min\.(js|css)")


def tracked_files(root):
    """Paths of the files under version control, or of all files where git cannot tell."""
    listing = subprocess.run(["git", "-c", "safe.directory=*", "-C", root, "ls-files", "-z"], text=True,
                             capture_output=True)
    if listing.returncode == 0:
        names = [pathlib.PurePath(name) for name in listing.stdout.split("\0") if name]
    else:
        names = [path.relative_to(root) for path in root.rglob("*")]
        names = [name for name in names if name.parts[0] not in (".git", "build", "results")]
    return [name for name in sorted(names) if (root / name).is_file()]


def check(root):
    """Violations, one line each."""
    problems = []
    for name in tracked_files(root):
        if name.suffix in BINARY or FOREIGN.fullmatch(str(name)):
            continue
        content = (root / name).read_bytes()
        try:
            text = content.decode()
        except UnicodeDecodeError as error:
            problems.append(f"{name}: not UTF-8: {error}")
            continue
        if content and not content.endswith(b"\n"):
            problems.append(f"{name}: no newline at the end")
        for number, line in enumerate(text.split("\n"), 1):
            problems += [f"{name}:{number}: {what}" for pattern, what in FORBIDDEN if pattern.search(line)]
        if name.suffix == ".sh" or re.match(r"#!.*\b(ba)?sh\b", text):
            parsed = subprocess.run(["bash", "-n", root / name], text=True, capture_output=True)
            if parsed.returncode != 0:
                problems.append(f"{name}: {parsed.stderr.strip()}")
    return problems


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]))
    print("\n".join(found))
    sys.exit(1 if found else 0)
