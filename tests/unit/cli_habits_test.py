"""Conventions that people and scripts expect of any command: errors as objects, colours, standard input and output,
help, versions.
"""
import csv
import json
import os
import pathlib
import pty
import re
import resource
import shutil
import subprocess
import tempfile
import termios
import unittest

from programs import BINARIES, CAMPAIGNS, SMOKE, TIMEOUT_S, dispersa, run, smoke_text


class Errors(unittest.TestCase):
    def error(self, *arguments, code=2, **options):
        """The object on standard output; the text stands on stderr as without --json."""
        done = dispersa(*arguments, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        answer = json.loads(done.stdout)
        self.assertEqual((answer["schema"], answer["code"]), ("dispersa/error/1", code))
        plain = [word for word in arguments if word != "--json"]
        self.assertEqual(dispersa(*plain, **options).stderr, done.stderr)
        return answer["errors"], done.stderr

    def test_a_wrong_file_with_its_place(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "wrong.yaml"
            file.write_text(re.sub(r"cases: \d+", "cases: many", smoke_text()))
            line = next(i for i, text in enumerate(file.read_text().splitlines(), 1) if "cases: many" in text)
            for command in ("plan", "fly", "margins"):
                errors, text = self.error("--json", command, file)
                self.assertEqual(len(errors), 1)
                self.assertEqual({key: errors[0][key] for key in ("file", "line", "path", "message", "allowed")},
                                 {"file": str(file), "line": line, "path": "sampling.cases",
                                  "message": "'many' is not a number", "allowed": "a whole number from 1 to 4294967295"})
                self.assertEqual(text, f"{file}:{line}:{errors[0]['column']}: sampling.cases: 'many' is not a number, "
                                       "allowed: a whole number from 1 to 4294967295\n")

    def test_an_unusable_command_line(self):
        errors, _ = self.error("plan", SMOKE, "--cases", "0", "--json")
        self.assertEqual((errors[0]["message"], errors[0]["allowed"]),
                         ("--cases: '0' is out of range", "a whole number from 1 to 4294967295"))
        errors, _ = self.error("--json", "validat")
        self.assertEqual(errors[0]["message"], "unknown command 'validat' (did you mean 'validate'?)")
        self.assertTrue(errors[0]["allowed"].startswith("validate, optimize, "))
        errors, _ = self.error("fly", "--json", "--no-such-option", SMOKE)
        self.assertIn("--no-such-option", errors[0]["message"])
        self.error("--json")

    def test_what_a_command_finds_later(self):
        errors, _ = self.error("fly", "--json", "--case", "12", SMOKE)
        self.assertEqual((errors[0]["message"], errors[0]["allowed"]),
                         ("--case: the campaign has no case 12", "0 to 11"))
        self.error("replay", "--json", "/nowhere", "--case", "0")
        self.error("status", "--json", "--peer", "no such host:1", code=2)
        self.error("plan", "--json", SMOKE, env={**os.environ, "DISPERSA_LANES": "3"})

    def test_a_shared_files_problem_is_told_once(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(CAMPAIGNS, pathlib.Path(folder) / "c")
            vehicle = pathlib.Path(folder) / "c/vehicles/slv4.yaml"
            vehicle.write_text(vehicle.read_text().replace("schema:", "shape: 1\nschema:", 1))
            done = dispersa("validate", "table3.yaml", "nominal.yaml", cwd=vehicle.parent.parent)
            self.assertEqual(done.returncode, 2)
            first, second = done.stdout.splitlines()
            self.assertRegex(first, r"^vehicles/slv4\.yaml:\d+:1: shape: unknown key")
            self.assertEqual(second, "nominal.yaml: not valid, for the reasons above")
            answer = json.loads(dispersa("validate", "--json", "table3.yaml", "nominal.yaml", cwd=vehicle.parent.parent).stdout)
            self.assertEqual(len(answer["errors"]), 1)

    def test_no_object_without_json_and_validate_keeps_its_own(self):
        self.assertEqual(dispersa("plan", "/nowhere").stdout, "")
        answer = json.loads(dispersa("validate", "--json", "/nowhere").stdout)
        self.assertEqual((answer["schema"], answer["valid"]), ("dispersa/validate/1", False))

    def test_a_name_that_is_not_utf8(self):
        done = subprocess.run([BINARIES / "dispersa", "plan", "--json", b"\xff.yaml"], capture_output=True, timeout=TIMEOUT_S)
        self.assertEqual(json.loads(done.stdout)["errors"][0]["file"], "\ufffd.yaml")


class Values(unittest.TestCase):
    """Every option of every program takes its value by the same rules."""

    def refused(self, said, *arguments, program="dispersa", **options):
        done = run(program, *arguments, **options)
        self.assertEqual((done.returncode, done.stdout, done.stderr.splitlines()[0]), (2, "", said))

    def test_a_whole_number_is_decimal(self):
        fly = lambda *options: dispersa("fly", SMOKE, *options).stdout
        self.assertEqual(fly("--seed", "010", "--case", "010"), fly("--seed", "10", "--case", "10"))
        self.assertEqual(len(dispersa("plan", SMOKE, "--cases", "010", "--csv").stdout.splitlines()), 11)
        seeds = "allowed: a whole number from 0 to 18446744073709551615"
        for text in ("-1", "-5", "18446744073709551616", "99999999999999999999999"):
            self.refused(f"--seed: '{text}' is out of range, {seeds}", "fly", SMOKE, "--seed", text)
        for text in ("0x10", " 7", "+7", "7 ", "1e3", "-", "--7", ""):
            self.refused(f"--seed: '{text}' is not a whole number, {seeds}", "fly", SMOKE, "--seed", text)
        self.refused("--slots: '0x2' is not a whole number, allowed: a whole number from 1 to 1024",
                     "--peer", "here", "--slots", "0x2", program="dispersa-worker")
        priorities = "allowed: a whole number from -1000 to 1000"
        self.refused(f"--priority: '-1001' is out of range, {priorities}", "launch", SMOKE, "--priority", "-1001")
        self.refused(f"--priority: '1001' is out of range, {priorities}", "launch", SMOKE, "--priority", "1001")
        self.assertNotIn("--priority", dispersa("launch", SMOKE, "--priority", "-1", "--peer", "no such host:1").stderr)
        self.refused("--domain: '0x1' is not a whole number, allowed: a whole number from 0 to 99", "list",
                     env={**os.environ, "DISPERSA_DOMAIN": "0x1"})

    def test_no_value_is_empty(self):
        with tempfile.TemporaryDirectory() as folder:
            campaign = pathlib.Path(folder) / "campaign.yaml"
            campaign.write_text("precious: 1\n")
            self.refused("directory: is empty, allowed: a folder", "init", "", cwd=folder)
            self.refused("--out: is empty, allowed: a file", "optimize", SMOKE, "-o", "", cwd=folder)
            # And what follows is not taken for it.
            self.refused("--picture: is empty, allowed: a file", "validate", "--picture=", campaign, SMOKE, cwd=folder)
            self.assertEqual((os.listdir(folder), campaign.read_text()), (["campaign.yaml"], "precious: 1\n"))
        self.refused("--autopilot: is empty, allowed: a file", "run", SMOKE, "--autopilot", "")
        self.refused("--out: is empty, allowed: a folder", "compare", "a", "b", "--out", "")
        self.refused("--metric: is empty, allowed: a metric", "compare", "a", "b", "--metric", "")
        self.refused("files: is empty, allowed: a file", "validate", SMOKE, "")
        self.refused("--data: is empty, allowed: a folder", "--data", "", program="dispersa-coordinator")
        self.refused("--peer: is empty, allowed: a text", "--peer", "", program="dispersa-worker")

    def test_a_number_is_finite(self):
        for text in ("nan", "inf", "0x10", " 7", "7 %", ""):
            self.refused(f"--frequency-band: '{text}' is not a number, allowed: a number", "margins", SMOKE,
                         "--frequency-band", text)
        self.refused("--audit: 'nan' is not a number, allowed: a number", "--audit", "nan", program="dispersa-coordinator")
        for text in ("-1", "1e9"):  # by its own range
            self.assertIn("--frequency-band: Value", dispersa("margins", SMOKE, "--frequency-band", text).stderr)

    def test_one_of_those_that_are_listed(self):
        formats = "allowed: one of csv, geojson, hdf5, jsonl, junit, kml, markdown"
        self.refused(f"--format: there is no 'xml' (did you mean 'kml'?), {formats}", "export", "results", "--format", "xml")
        self.refused(f"--format: there is no '0', {formats}", "export", "results", "--format", "0")
        self.refused(f"--format: there is no '', {formats}", "export", "results", "--format", "")


def on_terminal(command, columns=80, **environment):
    """What a command writes to a terminal that is its standard error."""
    ours, theirs = pty.openpty()
    termios.tcsetwinsize(theirs, (24, columns))
    process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=theirs)
    os.close(theirs)
    text = b""
    try:
        while part := os.read(ours, 4096):
            text += part
    except OSError:
        pass  # the other end is closed
    os.close(ours)
    process.wait(TIMEOUT_S)
    return text.decode()


class Progress(unittest.TestCase):
    def test_is_drawn_over_on_a_narrow_terminal(self):
        command = [str(BINARIES / "dispersa"), "run", str(SMOKE), "--workers", "0", "--no-histories", "--out"]
        for columns in (20, 60, 200):
            with tempfile.TemporaryDirectory() as folder:
                text = on_terminal([*command, folder + "/out"], columns, **os.environ)
            bars = [line.removeprefix("\x1b[K") for line in re.split(r"[\r\n]+", text) if line.startswith("\x1b[K")]
            self.assertTrue(bars, text)
            self.assertLess(max(map(len, bars)), columns)
            self.assertEqual("12/12" in text, columns == 200 or columns == 60, text)


class Network(unittest.TestCase):
    def test_names_an_interface_that_is_down(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(["unshare", "-r", "-n", BINARIES / "dispersa", "run", SMOKE, "--workers", "1", "--out",
                                   folder + "/out"], capture_output=True, text=True, timeout=TIMEOUT_S)
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertIn("the network interface lo of 127.0.0.1 is down: `ip link set lo up` brings it up\n", done.stderr)


class Colors(unittest.TestCase):
    # Its vehicle is like none that is known, which is warned of.
    COMMAND = [str(BINARIES / "dispersa"), "plan", "--cases", "1", str(CAMPAIGNS.parent / "tests/data/yaml/campaign.yaml")]

    def warn(self, *options, terminal, **environment):
        variables = {key: value for key, value in os.environ.items() if key != "NO_COLOR"}
        variables.update(environment, TERM="xterm")
        command = [*self.COMMAND, *options]
        if not terminal:
            return subprocess.run(command, env=variables, capture_output=True, text=True, timeout=TIMEOUT_S).stderr
        return on_terminal(command, **variables)

    def test_who_wants_colours(self):
        for expected, terminal, options, environment in [
                (True, True, [], {}), (False, False, [], {}),
                (False, True, [], {"NO_COLOR": "1"}), (True, True, [], {"NO_COLOR": ""}),
                (True, False, ["--color", "always"], {}), (True, False, ["--color", "always"], {"NO_COLOR": "1"}),
                (False, True, ["--color", "never"], {}), (False, True, ["--color", "auto"], {"NO_COLOR": "1"})]:
            text = self.warn(*options, terminal=terminal, **environment)
            self.assertIn("warning", text)
            self.assertEqual("\x1b[" in text, expected, (terminal, options, environment, text))

    def test_others_are_refused(self):
        done = dispersa("--color", "sometimes", "plan", SMOKE)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--color: there is no 'sometimes', allowed: one of auto, always, never\n", done.stderr)


class Streams(unittest.TestCase):
    def test_a_campaign_from_standard_input(self):
        from_file = dispersa("plan", "--csv", SMOKE)
        piped = dispersa("plan", "--csv", "-", input=SMOKE.read_text(), cwd=CAMPAIGNS)
        self.assertEqual((piped.returncode, piped.stdout), (0, from_file.stdout), piped.stderr)
        # It is read once, though fly asks first what kind of file it is.
        self.assertEqual(dispersa("fly", "-", "--case", "1", input=SMOKE.read_text(), cwd=CAMPAIGNS).stdout,
                         dispersa("fly", SMOKE, "--case", "1").stdout)

    def test_its_errors_are_of_stdin(self):
        text = re.sub(r"cases: \d+", "cases: many", SMOKE.read_text())
        done = dispersa("plan", "-", input=text, cwd=CAMPAIGNS)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^<stdin>:\d+:\d+: sampling\.cases: 'many' is not a number, allowed: ")
        # Names in it are relative to the current folder.
        with tempfile.TemporaryDirectory() as folder:
            done = dispersa("plan", "-", input=SMOKE.read_text(), cwd=folder)
        self.assertIn("file 'vehicles/slv4.yaml' not found", done.stderr)

    def test_other_files_from_standard_input(self):
        vehicle = (CAMPAIGNS / "vehicles/slv4.yaml").read_text()
        self.assertTrue(dispersa("validate", "-", input=vehicle).stdout.startswith("<stdin>: valid\n"))
        pid = CAMPAIGNS / "autopilots/pid.yaml"
        self.assertEqual(dispersa("fly", SMOKE, "--autopilot", "-", "--json", input=pid.read_text()).stdout,
                         dispersa("fly", SMOKE, "--autopilot", pid, "--json").stdout)
        done = run("dispersa-coordinator")
        self.assertEqual((done.returncode, done.stderr), (2, "give one of --data, --health and --drain\n"))

    def test_a_file_to_standard_output(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "history.csv"
            told = dispersa("fly", SMOKE, "--history", file)
            piped = dispersa("fly", SMOKE, "--history", "-", cwd=folder)
            self.assertEqual((piped.returncode, piped.stdout, piped.stderr), (0, file.read_text(), told.stdout))
            self.assertEqual(os.listdir(folder), ["history.csv"])
        scenario = CAMPAIGNS / "scenarios/nesc_case09.yaml"
        rows = list(csv.reader(dispersa("fly", scenario, "--history", "-").stdout.splitlines()))
        self.assertEqual((rows[0][0], len(rows)), ("time_s", 32))
        picture = dispersa("validate", CAMPAIGNS / "vehicles/slv4.yaml", "--picture", "-")
        self.assertTrue(picture.stdout.startswith("<svg ") and picture.stdout.endswith("</svg>\n"), picture.stdout[-80:])
        self.assertIn("valid", picture.stderr)

    def test_one_thing_at_a_time_on_standard_output(self):
        done = dispersa("fly", SMOKE, "--history", "-", "--json")
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr, "--history: '-' is standard output, where --json prints its object, "
                                      "allowed: a file, or no --json\n")

    def test_exports(self):
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder) / "results"
            dispersa("run", SMOKE, "--workers", "0", "--no-histories", "--quiet", "--out", results)
            for form in ("csv", "jsonl", "junit", "geojson", "kml"):
                file = pathlib.Path(folder) / form
                self.assertEqual(dispersa("export", results, "--format", form, "--out", file, "--quiet").returncode, 0)
                piped = dispersa("export", results, "--format", form, "--out", "-", "--quiet")
                self.assertEqual((piped.returncode, piped.stdout), (0, file.read_text()), form)
                told = dispersa("export", results, "--format", form, "--out", file, "--json", "--quiet")
                self.assertEqual(json.loads(told.stdout), {"schema": "dispersa/export/1", "file": str(file)})
            self.assertEqual(dispersa("export", results, "--format", "hdf5", "--out", "-").returncode, 2)
            history = dispersa("replay", results, "--case", "1", "--history", "-")
            self.assertEqual(history.stdout, dispersa("fly", SMOKE, "--case", "1", "--history", "-").stdout)
            self.assertIn("case 1: reproduced to the last bit", history.stderr)
            self.assertEqual(dispersa("optimize", CAMPAIGNS / "slv4_500km.yaml", "--out", "-").returncode, 2)

    def test_a_script_as_an_object(self):
        answer = json.loads(dispersa("completion", "zsh", "--json").stdout)
        self.assertEqual((answer["schema"], answer["shell"]), ("dispersa/completion/1", "zsh"))
        self.assertEqual(answer["script"], dispersa("completion", "zsh").stdout)

    def test_a_standard_output_that_takes_nothing_is_no_success(self):
        for place, why in ((">/dev/full", "no space left on the disk"), (">&-", "it is closed")):
            lost = f"standard output cannot be written: {why}\n"
            for command in ("dispersa --help", "dispersa --version", "dispersa-worker --version --json",
                            "dispersa-coordinator --help", "dispersa completion words ''", "dispersa completion bash",
                            f"dispersa plan {SMOKE}", f"dispersa plan {SMOKE} --csv --cases 100"):  # at the end; sooner
                done = subprocess.run(["sh", "-c", f"{BINARIES}/{command} {place}"], capture_output=True, text=True,
                                      timeout=TIMEOUT_S)
                self.assertEqual((done.returncode, done.stderr), (5, lost), command)
            done = subprocess.run(["sh", "-c", f"{BINARIES}/dispersa fly {SMOKE} --history - {place}"], capture_output=True,
                                  text=True, timeout=TIMEOUT_S)
            self.assertEqual(done.returncode, 5)
            self.assertTrue(done.stderr.startswith("standard output: "), done.stderr)

    def test_a_standard_error_that_takes_nothing_changes_no_code(self):
        with tempfile.TemporaryDirectory() as folder:
            run = f"run {SMOKE} --workers 0 --no-histories --out {folder}/r"
            for code, command in ((0, run), (2, "plan /nowhere"), (2, "validat"), (5, f"plan {SMOKE} >/dev/full")):
                done = subprocess.run(["sh", "-c", f"{BINARIES}/dispersa {command} 2>/dev/full"], stdout=subprocess.DEVNULL,
                                      timeout=TIMEOUT_S)
                self.assertEqual(done.returncode, code, command)

    def test_no_file_takes_the_place_of_a_closed_stream(self):
        with tempfile.TemporaryDirectory() as folder:
            command = f"{BINARIES}/dispersa run {SMOKE} --cases 1 --workers 0 --no-histories --quiet --out {folder}/r >&- 2>&-"
            self.assertEqual(subprocess.run(["sh", "-c", command], timeout=TIMEOUT_S).returncode, 5)
            self.assertEqual(len((pathlib.Path(folder) / "r/cases.csv").read_text().splitlines()), 2)


class Help(unittest.TestCase):
    def test_every_command_shows_the_options_of_all(self):
        words = [line.split("\t")[0] for line in dispersa("completion", "words", "").stdout.splitlines()]
        self.assertGreater(len(words), 20)
        for command in [[word] for word in words] + [["keys", "init"], ["keys", "issue"]]:
            text = dispersa(*command, "--help").stdout
            for option in ("--json", "--quiet", "--color"):
                self.assertEqual(len(re.findall(rf"^  {option}\b", text, re.MULTILINE)), 1, command)
            self.assertIn("Options of every command:", text)

    def test_values_are_named_by_what_they_are(self):
        text = dispersa("fly", "--help").stdout
        self.assertRegex(text, r"\n  campaign FILE \(required\)")
        self.assertIn("--integrator {simpson,erk4,cvode}", text)
        self.assertIn("-h, --help", text)


class Versions(unittest.TestCase):
    def test_all_programs_say_the_same(self):
        programs = ("dispersa", "dispersa-coordinator", "dispersa-worker")
        texts = [run(program, "--version").stdout for program in programs]
        self.assertRegex(texts[0], r"^dispersa \d+\.\d+\.\d+\+[0-9a-f]{12}\n$")
        self.assertEqual([text.split(" ", 1) for text in texts], [[name, texts[0].split(" ", 1)[1]] for name in programs])
        answers = [json.loads(run(program, "--version", "--json").stdout) for program in programs]
        self.assertEqual(answers, [answers[0]] * 3)
        self.assertEqual(answers[0]["schema"], "dispersa/version/1")
        self.assertEqual(texts[0].split()[1], answers[0]["engine"])

    def test_the_daemons_refuse_as_objects_too(self):
        for program in ("dispersa-coordinator", "dispersa-worker"):
            done = run(program, "--no-such-option", "--json")
            self.assertEqual((done.returncode, json.loads(done.stdout)["schema"]), (2, "dispersa/error/1"))


class Plan(unittest.TestCase):
    def test_a_screen_of_a_large_campaign(self):
        campaign = CAMPAIGNS / "full.yaml"
        done = dispersa("plan", campaign, "--cases", "200")
        lines = done.stdout.splitlines()
        self.assertLess(len(lines), 80)
        columns = next(csv.reader(dispersa("plan", campaign, "--cases", "1", "--csv").stdout.splitlines()))
        inputs = int(re.match(r"full: 200 cases, seed \d+, (\d+) dispersed inputs$", lines[0])[1])
        self.assertIn(f"Shown: 20 of {inputs} inputs, ", lines[-1])
        self.assertIn("Drawn as declared: ", lines[-2])
        heading = next(line for line in lines if line.startswith("case "))
        self.assertRegex(heading, r"^case +unit +0 +1 ")
        rows = [line for line in lines if line.startswith("  ")]
        self.assertEqual(len(rows), 2 * 20)
        # What is called by its stem and unit is an input of cases.csv, and numbers end where their headings end.
        suffix = {"°": "_deg", "m/s": "_m_s", "m": "_m", "": "", "°/s": "_deg_s", "s": "_s", "rad": "_rad"}
        for row in rows:
            name, unit = row[2:row.index("  ", 2)], row[heading.index("unit"):][:6].strip()
            self.assertIn(f"input_{name}{suffix[unit]}", columns)
            self.assertEqual(len(row), len(heading) if row in lines[lines.index(heading):] else len(row))

    def test_tables_for_programs_come_as_they_are_drawn(self):
        for form in ("--csv", "--json"):
            command = [BINARIES / "dispersa", "plan", SMOKE, "--cases", "4294967295", form]
            little = lambda: resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
            with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, preexec_fn=little) as process:
                self.assertTrue(process.stdout.read(1 << 16).startswith((b"case_index,", b'{\n  "schema"')))
                process.kill()
        rows = csv.DictReader(dispersa("plan", SMOKE, "--cases", "3", "--csv").stdout.splitlines())
        cases = json.loads(dispersa("plan", SMOKE, "--cases", "3", "--json").stdout)["cases"]
        self.assertEqual([{"case_index": case["case_index"], **{f"input_{key}": value for key, value in case["inputs"].items()}}
                          for case in cases], [{key: json.loads(value) for key, value in row.items()} for row in rows])

    def test_all_of_it(self):
        done = dispersa("plan", SMOKE, "--cases", "30", "--all")
        cases = [word for line in done.stdout.splitlines() if line.startswith("case ") for word in line.split()[2:]]
        self.assertEqual(cases, [str(i) for i in range(30)])
        self.assertNotIn("Shown: ", done.stdout)
        # The same numbers as in the table for programs.
        rows = list(csv.DictReader(dispersa("plan", SMOKE, "--cases", "30", "--csv").stdout.splitlines()))
        shown = [float(word) for line in done.stdout.split("\ncase ", 1)[1].splitlines() if line.startswith("  drag_factor")
                 for word in line.split()[1:]]
        self.assertEqual(shown, [float(f"{float(row['input_drag_factor']):.5g}") for row in rows])


if __name__ == "__main__":
    unittest.main()
