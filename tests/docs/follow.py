"""Does what a page says: its ```sh blocks, in order, in one shell, in an empty folder.

    follow.py PAGE.md [--programs BIN] [--header control_law.h]

A block's last command must succeed, all of it if it is a pipe. A ```text block right after it is what it prints: each of its lines must be among the
block's output, in this order, where "…" stands for anything.
"""
import argparse
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^```(sh|text)\n(.*?)^```$", re.M | re.S)
MARK = "@@follow@@"
TIMEOUT_S = 900
PIPE_CLOSED = 128 + signal.SIGPIPE


def steps(page):
    """(commands, lines that they print or None) of each ```sh block."""
    found = []
    end = None
    for match in BLOCK.finditer(page):
        kind, text = match.groups()
        between = page[end:match.start()].strip() if end is not None else None
        if kind == "sh":
            found.append((text, None))
        elif found and found[-1][1] is None and between == "":
            found[-1] = (found[-1][0], text.splitlines())
        end = match.end()
    return found


def pattern(line):
    return ".*".join(re.escape(part) for part in line.split("…"))


def missing(expected, output):
    """The first expected line that does not come, or None."""
    lines = iter(output)
    for line in expected:
        if not any(re.fullmatch(pattern(line), printed) for printed in lines):
            return line
    return None


def exit_code(codes):
    """Of a pipe's commands, the first that is not 0. `| head` ends whoever has more to say by SIGPIPE, which is no failure."""
    *earlier, last = map(int, codes)
    return next((code for code in earlier if code not in (0, PIPE_CLOSED)), last)


def follow(page, folder, environment):
    """What went otherwise than the page says; empty if nothing."""
    blocks = steps(page)
    if not blocks:
        return ["the page has no ```sh block"]
    script = "".join(f"{commands}\nprintf '\\n{MARK}%s\\n' \"${{PIPESTATUS[*]}}\"\n" for commands, _ in blocks)
    done = subprocess.run(["bash", "-c", script], cwd=folder, env=environment, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=TIMEOUT_S, start_new_session=True)
    parts = re.split(rf"\n{MARK}([\d ]+)\n", done.stdout)
    problems = []
    for i, (commands, expected) in enumerate(blocks):
        if 2 * i + 1 >= len(parts):
            return problems + [f"the shell ended before:\n{commands}"]
        output, code = parts[2 * i], exit_code(parts[2 * i + 1].split())
        if code != 0:
            problems.append(f"exit code {code} of:\n{commands}which printed:\n{output}")
        lost = missing(expected or [], output.splitlines())
        if lost is not None:
            problems.append(f"not printed: {lost!r} by:\n{commands}which printed:\n{output}")
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--programs", type=pathlib.Path)
    parser.add_argument("--header", type=pathlib.Path)
    options = parser.parse_args()
    # What `ls` lists first is the locale's. The domain is one that no `dispersa run` takes (40 to 99, private_domain.cc).
    environment = {**os.environ, "LC_ALL": "C.UTF-8", "NO_COLOR": "1", "DISPERSA_DOMAIN": str(20 + os.getpid() % 20)}
    if options.programs:
        environment["PATH"] = f"{options.programs}:{environment['PATH']}"
    with (tempfile.TemporaryDirectory(prefix="dispersa-page-") as folder,
          tempfile.TemporaryDirectory(prefix="dispersa-include-") as include):
        if options.header:  # as it is installed
            (pathlib.Path(include) / "dispersa").mkdir()
            shutil.copy(options.header, pathlib.Path(include) / "dispersa")
            environment["CPATH"] = include
        problems = follow(options.page.read_text(), folder, environment)
    for problem in problems:
        print(f"{options.page.name}: {problem}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
