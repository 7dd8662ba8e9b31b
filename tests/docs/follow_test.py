"""follow.py detects a page that is wrong."""
import os
import tempfile
import unittest

import follow


def problems(page):
    with tempfile.TemporaryDirectory() as folder:
        return follow.follow(page, folder, dict(os.environ))


class FollowTest(unittest.TestCase):
    def test_a_right_page(self):
        self.assertEqual([], problems("```sh\necho one; x=two\n```\n\n```text\none\n```\n\nand\n\n```sh\necho $x; ls\n```\n\n```text\ntw…\n```\n"))

    def test_a_command_that_fails(self):
        self.assertIn("exit code 3", problems("```sh\n(exit 3)\n```\n")[0])

    def test_a_command_that_fails_before_a_pipe(self):
        self.assertIn("exit code 3", problems("```sh\n(exit 3) | head -n 1\n```\n")[0])
        self.assertIn("exit code 141", problems("```sh\ntrue | (exit 141)\n```\n")[0])
        self.assertEqual([], problems("```sh\nyes | head -n 1\n```\n"))

    def test_another_output(self):
        self.assertIn("not printed: 'two'", problems("```sh\necho one\n```\n\n```text\ntwo\n```\n")[0])

    def test_lines_in_another_order(self):
        self.assertIn("not printed: 'one'", problems("```sh\necho one; echo two\n```\n\n```text\ntwo\none\n```\n")[0])

    def test_output_counts_only_right_after_its_commands(self):
        self.assertEqual([], problems("```sh\necho one\n```\n\nwords\n\n```text\ntwo\n```\n"))

    def test_a_shell_that_ends(self):
        self.assertIn("the shell ended", problems("```sh\nexit 0\n```\n")[0])

    def test_a_page_without_commands(self):
        self.assertEqual(["the page has no ```sh block"], problems("words"))


if __name__ == "__main__":
    unittest.main()
