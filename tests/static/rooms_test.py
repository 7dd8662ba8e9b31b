"""rooms.py finds violations in made-up trees."""
import pathlib
import tempfile
import unittest

import rooms

CMAKE = 'set(DISPERSA_LINKS_math "")\nset(DISPERSA_LINKS_flight math)\n'


class RoomsTest(unittest.TestCase):
    def check(self, page):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / rooms.PAGE).parent.mkdir(parents=True)
            (root / rooms.PAGE).write_text(page)
            (root / "CMakeLists.txt").write_text(CMAKE)
            return rooms.check(root)

    def test_accepts_every_room_once(self):
        self.assertEqual(self.check("| module | purpose | never |\n|---|---|---|\n| `math` | numbers | waits |\n\n| other | table |\n|---|---|\n"
                                    "| `x` | y |\n\n| module | purpose | never |\n|---|---|---|\n| `flight` | flies | waits |\n"), [])

    def test_finds_missing_foreign_and_repeated_rooms(self):
        page = ("| module | purpose | never |\n|---|---|---|\n| `math` | numbers | waits |\n| `math` | again | waits |\n"
                "| `old` | gone | waits |\n")
        self.assertEqual(self.check(page), [
            "services/docs/pages/architecture.md: the module flight of CMakeLists.txt is missing",
            "services/docs/pages/architecture.md: old is no module of CMakeLists.txt",
            "services/docs/pages/architecture.md: math is listed 2 times",
        ])

    def test_finds_a_room_without_a_never(self):
        page = "| module | purpose | never |\n|---|---|---|\n| `math` | numbers | waits |\n| `flight` | flies | |\n"
        self.assertEqual(self.check(page), ["services/docs/pages/architecture.md: the module flight of CMakeLists.txt is missing"])

    def test_finds_a_path_that_is_gone(self):
        page = ("| module | purpose | never |\n|---|---|---|\n| `math` | numbers | waits |\n| `flight` | flies | waits |\n\n"
                "`services/docs/pages/` `core/gone.h`\n")
        self.assertEqual(self.check(page), ["services/docs/pages/architecture.md: core/gone.h does not exist"])


if __name__ == "__main__":
    unittest.main()
