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
        self.assertEqual(self.check("| room | purpose |\n|---|---|\n| `math` | numbers |\n\n| other | table |\n|---|---|\n"
                                    "| `x` | y |\n\n| room | purpose |\n|---|---|\n| `flight` | flies |\n"), [])

    def test_finds_missing_foreign_and_repeated_rooms(self):
        page = "| room | purpose |\n|---|---|\n| `math` | numbers |\n| `math` | again |\n| `old` | gone |\n"
        self.assertEqual(self.check(page), [
            "services/docs/pages/architecture.md: the room flight of CMakeLists.txt is missing",
            "services/docs/pages/architecture.md: old is no room of CMakeLists.txt",
            "services/docs/pages/architecture.md: math is listed 2 times",
        ])


if __name__ == "__main__":
    unittest.main()
