"""Completion in bash, zsh and fish, each used as its user does, with the scripts that the program prints.
"""
import functools
import os
import re
import select
import pty
import shutil
import subprocess
import time
import unittest

from programs import BINARIES, TIMEOUT_S, folder_of


def output(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=TIMEOUT_S, check=True,
                          **options).stdout


def words(*line, program="dispersa"):
    return [answer.split("\t")[0] for answer in output(BINARIES / program, "completion", "words", *line).splitlines()]


@functools.cache
def printed(shell):
    return output(BINARIES / "dispersa", "completion", shell)


class Words(unittest.TestCase):
    """What the program says may stand at the end of a line."""

    def test_commands_and_their_commands(self):
        self.assertTrue({"validate", "run", "keys", "completion"} <= set(words("")))
        self.assertEqual(words("f"), ["fly", "fsck", "fetch"])
        self.assertEqual(words("keys", ""), ["init", "issue", "revoke", "list", "renew", "retire"])
        # As parsed: an option's value is no command.
        self.assertEqual(words("--color", "keys", "v"), ["validate"])

    def test_options_of_the_command_and_of_all(self):
        self.assertEqual(words("fly", "--c"), ["--case", "--color"])
        self.assertEqual(words("keys", "issue", "--"), ["--help", "--days", "--role", "--name", "--may", "--json", "--quiet", "--color"])
        self.assertIn("-o", words("tune", "-"))
        self.assertEqual(words("fly", "--", "--"), [":file"])

    def test_values(self):
        self.assertEqual(words("export", "results", "--format", "j"), ["jsonl", "junit"])
        self.assertEqual(words("export", "--format=j"), ["--format=jsonl", "--format=junit"])
        self.assertEqual(words("export", "--format", "=", "j"), ["jsonl", "junit"])  # bash's words
        self.assertEqual(words("export", "--format", "="), ["csv", "geojson", "hdf5", "jsonl", "junit", "kml", "markdown"])
        self.assertEqual(words("keys", "issue", "authority", "--role", "w"), ["worker"])
        self.assertEqual(words("completion", ""), ["bash", "fish", "zsh"])
        self.assertEqual(words("init", "first", "--from", ""), ["slv4", "vega", "electron", "scout"])
        self.assertEqual(words("schema", ""), ["campaign", "vehicle", "reference", "autopilot", "scenario"])
        self.assertEqual(words("run", "--cases", ""), [])

    def test_metrics(self):
        self.assertEqual(words("search", "campaign.yaml", "--metric", "pitch_error_peak_d"), ["pitch_error_peak_deg"])
        self.assertEqual(words("compare", "a", "b", "--metric=q_m"), ["--metric=q_max_pa"])
        self.assertGreater(len(words("compare", "a", "b", "--metric", "")), 50)
        self.assertTrue({"apogee_km", "pitch_error_rms_stage1_deg", "yaw_error_rms_deg"}
                        <= set(words("compare", "a", "b", "--metric", "q_max_pa", "--metric", "")))

    def test_files_and_folders(self):
        self.assertEqual(words("fly", ""), [":file"])
        self.assertEqual(words("fly", "campaign.yaml", ""), [])
        self.assertEqual(words("validate", "one.yaml", "two.yaml", ""), [":file"])
        self.assertEqual(words("run", "campaign.yaml", "--out", ""), [":folder"])
        self.assertEqual(words("compare", "a", ""), [":folder"])
        self.assertEqual(words("--data", "", program="dispersa-coordinator"), [":folder"])

    def test_files_of_yaml(self):
        def kinds(*line):
            return output(BINARIES / "dispersa", "completion", "words", *line)

        for line in (["run", ""], ["fly", ""], ["plan", ""], ["launch", ""], ["search", ""], ["tune", ""], ["margins", ""],
                     ["optimize", ""], ["modes", ""], ["validate", "one.yaml", ""], ["run", "a.yaml", "--autopilot", ""]):
            self.assertEqual(kinds(*line), ":file\tyaml\n", line)
        for line in (["fly", "a.yaml", "--history", ""], ["export", "results", "--out", ""]):
            self.assertEqual(kinds(*line), ":file\n", line)

    def test_each_candidate_is_one_line_that_says_what_it_is(self):
        for line in output(BINARIES / "dispersa", "completion", "words", "").splitlines():
            self.assertRegex(line, r"^[a-z]+\t\S")


class Shells(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of(self)
        (self.folder / "two words.yaml").touch()
        (self.folder / "table.yaml").touch()
        (self.folder / "tables").mkdir()
        (self.folder / "score.csv").touch()
        (self.folder / "score.yml").touch()
        self.environment = {"PATH": f"{BINARIES}:{os.environ['PATH']}", "HOME": str(self.folder), "TERM": "dumb",
                            "LANG": "C.UTF-8"}

    def script(self, shell):
        # Not among the files that are completed.
        file = self.folder / f".completion.{shell}"
        file.write_text(printed(shell))
        return file

    def bash(self, *line):
        quoted = " ".join("'" + word + "'" for word in line)
        return output("bash", "--norc", "-c", f"source {self.script('bash')}; COMP_WORDS=({quoted}); "
                      "COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); "
                      "function=$(complete -p \"${COMP_WORDS[0]}\" | sed 's/.*-F \\([^ ]*\\) .*/\\1/'); $function; "
                      "printf '%s\\n' \"${COMPREPLY[@]}\"", cwd=self.folder, env=self.environment).split("\n")[:-1]

    def test_bash(self):
        self.assertEqual(self.bash("dispersa", "f"), ["fly", "fsck", "fetch"])
        self.assertEqual(self.bash("dispersa", "fly", "--int"), ["--integrator"])
        self.assertEqual(self.bash("dispersa", "fly", "--integrator", ""), ["simpson", "erk4", "cvode"])
        self.assertEqual(self.bash("dispersa", "fly", "--integrator", "=", "e"), ["erk4"])
        self.assertEqual(sorted(self.bash("dispersa", "fly", "t")), ["table.yaml", "tables", "two words.yaml"])
        self.assertEqual(self.bash("dispersa", "run", "table.yaml", "--out", "t"), ["tables"])
        self.assertEqual(self.bash("dispersa", "fly", "table.yaml", "--history", "score.c"), ["score.csv"])
        self.assertEqual(self.bash("dispersa", "fly", "sc"), ["score.yml"])
        self.assertEqual(self.bash("dispersa", "search", "table.yaml", "--metric", "perig"), ["perigee_km"])
        self.assertEqual(self.bash("dispersa-worker", "--pe"), ["--peer"])

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed (tests/packages.txt)")
    def test_fish(self):
        def fish(line):
            text = output("fish", "--no-config", "-c", f"source {self.script('fish')}; complete -C '{line}'",
                          cwd=self.folder, env=self.environment)
            return [answer.split("\t")[0] for answer in text.splitlines()]

        self.assertEqual(sorted(fish("dispersa f")), ["fetch", "fly", "fsck"])
        self.assertEqual(fish("dispersa fly --int"), ["--integrator"])
        self.assertEqual(sorted(fish("dispersa fly --integrator ")), ["cvode", "erk4", "simpson"])
        self.assertEqual(fish("dispersa fly --integrator=e"), ["--integrator=erk4"])
        self.assertEqual(sorted(fish("dispersa fly t")), ["table.yaml", "tables/", "two words.yaml"])
        self.assertEqual(fish("dispersa fly table.yaml --history score.c"), ["score.csv"])
        self.assertEqual(fish("dispersa fly sc"), ["score.yml"])
        self.assertEqual(fish("dispersa compare a b --metric perig"), ["perigee_km"])
        self.assertEqual(fish("dispersa run table.yaml --out t"), ["tables/"])
        self.assertEqual(fish("dispersa run table.yaml --out=t"), ["--out=tables/"])
        self.assertEqual(fish("dispersa-worker --pe"), ["--peer"])

    def zsh(self, line):
        """What stands on the line after Tab, in an interactive shell of its own terminal."""
        self.script("zsh").rename(self.folder / "_dispersa")
        (self.folder / ".zshrc").write_text(
            f"fpath=({self.folder} $fpath); autoload -Uz compinit; compinit -u -d {self.folder}/.dump\n"
            "zstyle ':completion:*' list-prompt ''; setopt no_beep; unsetopt prompt_cr prompt_sp; PS1='> '\n"
            "show() { print -r -- $'\\n'\"<$BUFFER>\"; BUFFER=; zle .accept-line }; zle -N show; bindkey '^X' show\n"
            "echo ready\n")
        process, terminal = pty.fork()
        if process == 0:
            os.chdir(self.folder)
            os.execvpe("zsh", ["zsh", "-i"], {**self.environment, "ZDOTDIR": str(self.folder)})
        text = ""

        def wait(pattern):
            nonlocal text
            end = time.monotonic() + TIMEOUT_S
            while not re.search(pattern, text, re.DOTALL):
                self.assertLess(time.monotonic(), end, text)
                if select.select([terminal], [], [], 0.2)[0]:
                    text += os.read(terminal, 4096).decode(errors="replace")
        try:
            wait("ready.*> ")
            os.write(terminal, line.encode() + b"\t\x18")
            wait("<dispersa[^>]*>")
        finally:
            os.close(terminal)
            os.waitpid(process, 0)
        return re.search("<(dispersa[^>]*)>", text)[1]

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed (tests/packages.txt)")
    def test_zsh(self):
        for line, completed in [("dispersa fe", "dispersa fetch "), ("dispersa fly --int", "dispersa fly --integrator "),
                                ("dispersa fly --integrator e", "dispersa fly --integrator erk4 "),
                                ("dispersa fly tw", "dispersa fly two\\ words.yaml "),
                                ("dispersa fly table.yaml --history score.c", "dispersa fly table.yaml --history score.csv "),
                                ("dispersa fly sc", "dispersa fly score.yml "),
                                ("dispersa search --metric perig", "dispersa search --metric perigee_km "),
                                ("dispersa run table.yaml --out t", "dispersa run table.yaml --out tables/"),
                                ("dispersa-worker --pe", "dispersa-worker --peer ")]:
            self.assertEqual(self.zsh(line), completed)


if __name__ == "__main__":
    unittest.main()
