"""The entries of compile_commands.json that are sources of the product."""
import pathlib

FOLDERS = ("core", "services")


def name_of(entry, root):
    """`core/math/a.cc` of such a source; `core/math`, where a module is compiled as one source (CMake writes it into the
    build folder); None for what is not the product's."""
    path = pathlib.Path(entry["directory"], entry["file"])
    if path.parent.name == "Unity":
        module = path.parts[:path.parts.index("CMakeFiles")]
        at = max((i for i, part in enumerate(module) if part in FOLDERS), default=None)
        return pathlib.Path(*module[at:]) if at is not None else None
    if path.is_relative_to(root) and path.relative_to(root).parts[0] in FOLDERS:
        return path.relative_to(root)
    return None
