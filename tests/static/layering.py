"""Checks that every include of the product stays within the link table of the top-level CMakeLists.txt.

usage: layering.py REPOSITORY
"""
import pathlib
import re
import sys

# Third-party headers that have an owner: pattern of the include, modules that may use it.
OWNED = [
    (r"(fastdds|fastrtps|fastcdr)/", {"idl", "transport"}),
    (r"yaml-cpp/", {"campaign_yaml"}),
    (r"(sundials|arkode|cvodes?|idas?|kinsol|nvector|sunmatrix|sunlinsol|sunnonlinsol)/", {"dynamics"}),
    (r"sleef\.h", {"math"}),
    (r"Random123/", {"random"}),
    (r"hdf5", {"results"}),
    (r"(seccomp\.h|linux/landlock\.h)", {"containment"}),
    (r"sqlite3\.h", {"results"}),
    (r"zlib\.h", {"coordinator", "results"}),
    (r"boost/(asio|beast)", {"http"}),
    (r"CLI/", {"program", "cli", "fleet_cli", "coordinator", "worker"}),
    (r"(pybind11/|Python\.h)", {"python", "fleet_python"}),
]


def link_table(cmake_text):
    """{module: set of modules that it links directly} from the DISPERSA_LINKS_* variables."""
    table = {}
    for name, links in re.findall(r"^set\(DISPERSA_LINKS_(\w+)\s+([^)]*)\)", cmake_text, re.MULTILINE):
        table[name] = set(links.replace('"', "").split())
    return table


def closure(table, module):
    """The module and everything that it may use, directly or not."""
    reached, pending = set(), [module]
    while pending:
        name = pending.pop()
        if name not in reached:
            reached.add(name)
            pending.extend(table.get(name, ()))
    return reached


def service_modules(cmake_text):
    """The modules that a build without the service lacks."""
    found = re.search(r"^set\(DISPERSA_SERVICE_MODULES\s+([^)]*)\)", cmake_text, re.MULTILINE)
    return set(found[1].split()) if found else set()


def source_files(root):
    """(module, path) of every source of the product."""
    for folder in ("core", "services"):
        for path in sorted((root / folder).glob("*/**/*")):
            if path.suffix in (".h", ".cc"):
                yield path.relative_to(root / folder).parts[0], path
    for path in sorted((root / "idl").glob("**/*")):
        if path.suffix in (".h", ".cc"):
            yield "idl", path


def module_of(include, generated):
    """The module that an include of the product's own headers names, or None."""
    parts = include.split("/")
    if parts[0] in ("core", "services") and len(parts) > 2:
        return parts[1]
    if parts[0] == "idl" or (len(parts) == 1 and re.fullmatch(generated, include)):
        return "idl"
    return None


def check(root):
    """Violations, one line each."""
    cmake_text = (root / "CMakeLists.txt").read_text()
    table, service = link_table(cmake_text), service_modules(cmake_text)
    problems = [f"CMakeLists.txt: module {module} needs {used} of the service, which a build without it lacks"
                for module in sorted(set(table) - service) for used in sorted(closure(table, module) & service)]
    for module in table:
        if any(module in closure(table, link) for link in table[module]):
            problems.append(f"CMakeLists.txt: module {module} uses itself through its links")
    stems = [re.escape(path.stem) for path in (root / "idl").glob("*.idl")]
    generated = rf"({'|'.join(stems)})(PubSubTypes|TypeObject)?\.h" if stems else r"(?!)"

    for module, path in source_files(root):
        place = path.relative_to(root)
        if module not in table:
            problems.append(f"{place}: module {module} has no DISPERSA_LINKS_{module} in CMakeLists.txt")
            continue
        allowed = closure(table, module)
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*([<"])([^>"]+)[>"]', line)
            if not match:
                continue
            bracket, include = match.groups()
            used = module_of(include, generated)
            if used is None and bracket == '"':
                problems.append(f'{place}:{number}: "{include}" is not a path from the repository root')
            elif used is not None and used not in allowed:
                problems.append(f"{place}:{number}: {module} includes {include} but may not use {used}")
            for pattern, owners in OWNED:
                if re.match(pattern, include) and module not in owners:
                    problems.append(f"{place}:{number}: {module} includes {include}, which only "
                                    f"{' and '.join(sorted(owners))} may")
    return problems


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]))
    print("\n".join(found))
    sys.exit(1 if found else 0)
