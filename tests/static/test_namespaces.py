"""Checks that each test source keeps its names to itself.

Twelve test sources are compiled as one (tests/CMakeLists.txt), where helpers and tests of the same name would clash. So
`margins_flight_test.cc` puts all that it declares into a namespace of its own:

    namespace dispersa::margins_flight_test {
    ...
    }  // namespace dispersa::margins_flight_test

and takes back each macro that it defines. The compiler does not warn of a helper there that nobody uses: this does.

usage: test_namespaces.py REPOSITORY
"""
import pathlib
import re
import sys

# A function or a value of the namespace itself.
HELPER = re.compile(r"^(?!TEST|TYPED_|INSTANTIATE|MATCHER|namespace|using|struct|class|enum|template|extern|[\s/#}])"
                    r"[^\n({=]*?\b(?!operator|PrintTo\b)(\w+)(?:\[\w*\])*(?=\(| =|\{)", re.M)
OUTSIDE = re.compile(r"\s*(//.*|#\s*include\b.*)?")  # what may stand outside the namespace


def violations(name, text):
    """What is wrong with one source, as (line, text)."""
    lines = text.split("\n")
    opening, closing = f"namespace dispersa::{name} {{", f"}}  // namespace dispersa::{name}"
    if lines.count(opening) != 1 or lines.count(closing) != 1:
        return [(1, f"is not in one `namespace dispersa::{name}`, opened and closed on lines of their own")]
    begin, end = lines.index(opening), lines.index(closing)
    found = [(number, "stands outside the source's namespace") for number, line in enumerate(lines, 1)
             if not begin < number <= end + 1 and not OUTSIDE.fullmatch(line)]
    for number, line in enumerate(lines, 1):
        macro = re.match(r"\s*#\s*define\s+(\w+)", line)
        if macro and not re.search(rf"^\s*#\s*undef\s+{macro.group(1)}$", text, re.M):
            found.append((number, f"defines {macro.group(1)}, and no #undef takes it back"))
    for helper in HELPER.finditer(text):
        if len(re.findall(rf"\b{helper[1]}\b", text)) == 1:
            found.append((text.count("\n", 0, helper.start()) + 1, f"declares {helper[1]}, which nobody uses"))
    return found


def tests_of(text):
    """(suite, test) of each test that a source declares."""
    return re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", text, re.M)


def check(root):
    """Violations, one line each."""
    problems, seen, owners = [], 0, {}
    for path in sorted((root / "tests").glob("*/*_test.cc")):
        seen += 1
        text, name = path.read_text(), path.relative_to(root)
        problems += [f"{name}:{number}: {what}" for number, what in violations(path.stem, text)]
        for test in tests_of(text):
            owner = owners.setdefault((path.parent, *test), name)
            if owner != name:
                problems.append(f"{name}: {'.'.join(test)} is a test of {owner} already")
    return problems if seen else ["no tests/*/*_test.cc"]


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]))
    print("\n".join(found))
    sys.exit(1 if found else 0)
