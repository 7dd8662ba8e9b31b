"""The docs' pages followed word for word by a new user: on a bare Debian with the Debian package and the packages
that a page asks for (`apt-get install …`), in a home folder, without a network.
"""
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
PAGES = HERE.parents[1] / "services" / "docs" / "pages"
sys.path.insert(0, str(HERE.parent / "install"))
from bare_root import BareRoot, where_possible  # noqa: E402


def needed(page):
    """The packages that a page tells its reader to install."""
    return [name for names in re.findall(r"`apt-get install ([^`]+)`", page) for name in names.split()]


@where_possible
class NewUser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-root-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.root = BareRoot(cls.folder)
        cls.root.take_package()
        # Python is for follow.py.
        done = cls.root.inside("apt-get update; apt-get install --yes /tmp/dispersa.deb; "
                               "apt-get install --yes --no-install-recommends python3; useradd --create-home ann")
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
        shutil.copy(HERE / "follow.py", cls.root.path / "opt")

    def test_pages_word_for_word(self):
        pages = [page for page in sorted(PAGES.glob("*.md")) if "```sh" in page.read_text()]
        self.assertGreaterEqual(len(pages), 6)
        # Those that need least first: what one page needs does not help another that forgot to say so.
        for page in sorted(pages, key=lambda page: len(needed(page.read_text()))):
            with self.subTest(page.name):
                if packages := needed(page.read_text()):
                    done = self.root.inside(f"apt-get install --yes {' '.join(packages)}")
                    self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])
                shutil.copy(page, self.root.path / "opt")
                done = self.root.inside("cd ~ann; exec runuser -u ann -- env HOME=\"$PWD\" TMPDIR=\"$PWD\" PATH=/usr/bin:/bin "
                                        f"python3 -B /opt/follow.py /opt/{page.name}", network=False)
                self.assertEqual(done.returncode, 0, done.stdout[-6000:] + done.stderr[-3000:])


if __name__ == "__main__":
    unittest.main()
