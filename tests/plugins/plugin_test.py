"""Control laws from shared objects: the bytes of their results equal those of the built-in laws, and any fault of
theirs is contained and named.

Environment: DISPERSA_BINARIES, DISPERSA_CAMPAIGNS; DISPERSA_SOURCE: the repository.
"""
import functools
import csv
import gzip
import hashlib
import html
import json
import os
import pathlib
import re
import shutil
import signal
import sqlite3
import subprocess
import tempfile
import time
import unittest
import unittest.mock

BINARIES = pathlib.Path(os.environ["DISPERSA_BINARIES"])
CAMPAIGNS = pathlib.Path(os.environ["DISPERSA_CAMPAIGNS"])
SOURCE = pathlib.Path(os.environ["DISPERSA_SOURCE"])
TIMEOUT_S = 240
CASES = 16
WHOLE = CAMPAIGNS / "table3.yaml"  # to injection
LOST = SOURCE / "tests/data/brief/lost.yaml"  # after four seconds: whatever a law does, it does in the third
PD = (SOURCE / "tests/data/brief/pd.yaml").read_text().split("\n", 2)[2]  # without its comment

BEHAVIOURS = {name: int(number) for name, number in
              re.findall(r"#define (\w+) +(\d+)", (SOURCE / "tests/plugins/law.c").read_text())}


class PluginTest(unittest.TestCase):
    programs = BINARIES

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        include = cls.folder / "include/dispersa"
        include.mkdir(parents=True)
        shutil.copy(SOURCE / "core/control/control_law.h", include)
        cls.pd = cls.run_cases("built_in", SOURCE / "tests/data/brief/pd.yaml").read_bytes()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def dispersa(cls, *arguments):
        return subprocess.run([cls.programs / "dispersa", *map(str, arguments)], cwd=cls.folder, text=True,
                              capture_output=True, timeout=TIMEOUT_S)

    @classmethod
    def compile(cls, name, *sources, flags=()):
        library = cls.folder / f"{name}.so"
        cxx = any(str(source).endswith(".cc") for source in sources)
        subprocess.run(["g++" if cxx else "gcc", "-O2", "-Wall", "-Wextra", "-Werror", "-fPIC", "-shared",
                        "-fvisibility=hidden", f"-I{cls.folder}/include", *flags, *map(str, sources), "-lm", "-o",
                        library], check=True, timeout=TIMEOUT_S)
        return library

    @classmethod
    def autopilot(cls, name, parameters=""):
        text = PD.replace("law: pd", "law: plugin").replace(
            "tick_s:", f"plugin: {{library: {name}.so{parameters}}}\ntick_s:")
        path = cls.folder / f"{name}.yaml"
        path.write_text(text)
        return path

    @classmethod
    @functools.cache
    def law(cls, behaviour, *flags):
        """An autopilot file with the misbehaving law."""
        name = behaviour.lower()
        cls.compile(name, SOURCE / "tests/plugins/law.c",
                    flags=[f"-DDISPERSA_MISBEHAVES={BEHAVIOURS[behaviour]}", *flags])
        return cls.autopilot(name)

    @classmethod
    def campaign_run(cls, name, autopilot, *options, workers=0, cases=CASES, campaign=LOST):
        out = cls.folder / "out" / name
        return out, cls.dispersa("run", campaign, "--autopilot", autopilot, "--cases", cases, "--workers", workers,
                                 "--no-histories", "--out", out, *options)

    @classmethod
    def run_cases(cls, name, autopilot, **options):
        out, ended = cls.campaign_run(name, autopilot, **options)
        if ended.returncode not in (0, 3, 4):
            raise AssertionError(ended.stderr)
        return out / "cases.csv"

    # ---- what a law may do ----

    def test_a_pd_gives_the_built_in_ones_bytes(self):
        self.compile("pd", SOURCE / "campaigns/control_laws/c/pd.c", flags=["-std=c99"])
        flown = [self.run_cases(name, autopilot, workers=workers, campaign=WHOLE, cases=8).read_bytes() for name, autopilot, workers in
                 (("pd_whole", SOURCE / "tests/data/brief/pd.yaml", 0), ("pd_here", self.autopilot("pd"), 0),
                  ("pd_workers", self.autopilot("pd"), 2))]
        self.assertEqual(flown[1:], flown[:1] * 2)

    def test_the_report_has_where_its_lost_flights_fall(self):
        self.compile("falls", SOURCE / "campaigns/control_laws/c/pd.c", flags=["-std=c99"])
        out = self.folder / "out/falls"
        ended = self.dispersa("run", LOST, "--autopilot", self.autopilot("falls"), "--cases", 2, "--workers", 0, "--quiet", "--out", out)
        self.assertEqual((ended.returncode, ended.stderr), (3, ""))
        with gzip.open(out / "histories/impacts.csv.gz", "rt") as points:
            self.assertEqual([row["lost"] for row in csv.DictReader(points)], ["1", "1"])

    def test_own_metrics_are_measured_under_it(self):
        self.compile("measured", SOURCE / "campaigns/control_laws/c/pd.c", flags=["-std=c99"])
        campaign = self.folder / "measured_campaign.yaml"
        campaign.write_text(f"schema: dispersa/campaign/1\nname: measured\nbased_on: {LOST}\nmetrics:\n"
                            "  - {name: swing_max_deg, expression: max(abs(deflection_pitch_deg))}\n"
                            "  - {name: told_max, expression: max(law_telemetry_1)}\n")
        outs = [self.folder / "out" / f"measured{workers}" for workers in (0, 2)]
        for workers, out in zip((0, 2), outs):
            ended = self.dispersa("run", campaign, "--autopilot", self.autopilot("measured"), "--cases", 6, "--workers", workers,
                                  "--no-histories", "--out", out)
            self.assertIn(ended.returncode, (0, 3, 4), ended.stderr)
        self.assertEqual((outs[0] / "cases.csv").read_bytes(), (outs[1] / "cases.csv").read_bytes())
        header, *rows = (outs[0] / "cases.csv").read_text().splitlines()
        values = [float(row.split(",")[header.split(",").index("metric_swing_max_deg")]) for row in rows]
        self.assertEqual(len([value for value in values if value > 0]), 6)

    def test_the_examples_fly_and_are_told_apart(self):
        sources = SOURCE / "campaigns/control_laws"
        self.compile("pid_filtered", sources / "cpp/pid_filtered.cc", flags=["-std=c++17"])
        self.compile("pitch_autopilot", *sorted((sources / "simulink").glob("*.c")), flags=["-std=c99"])
        flown = set()
        for name, parameters in (("pid_filtered", ", parameters: {integral_time_s: 2, filter_rad_s: 200}"),
                                 ("pitch_autopilot", "")):
            cases = self.run_cases(name, self.autopilot(name, parameters), campaign=WHOLE, cases=4)
            self.assertEqual(len(cases.read_text().splitlines()), 5)
            self.assertIn(",completed,", cases.read_text())
            flown.add(cases.read_bytes())
        self.assertEqual(len(flown), 2)

    def test_deflections_are_commands_too(self):
        for ours, theirs in zip(self.rows(self.run_cases("deflects", self.law("DEFLECTS")).read_text()),
                                self.rows(self.pd.decode())):
            self.assertAlmostEqual(ours["metric_pitch_error_rms_deg"], theirs["metric_pitch_error_rms_deg"], delta=1e-6)

    @staticmethod
    def rows(text):
        head, *lines = (line.split(",") for line in text.splitlines())
        names = ["metric_pitch_error_rms_deg"]
        return [{name: float(line[head.index(name)]) for name in names} for line in lines]

    def test_a_result_folder_flies_again_without_the_object(self):
        library = self.compile("away", SOURCE / "tests/plugins/law.c")
        out, ended = self.campaign_run("away", self.autopilot("away"))
        self.assertEqual(ended.returncode, 3, ended.stderr)
        sha256 = subprocess.run(["sha256sum", library], check=True, text=True, capture_output=True).stdout.split()[0]
        self.assertIn(sha256, (out / "campaign.yaml").read_text())
        self.assertIn(sha256, (out / "report.html").read_text())
        library.unlink()
        again = self.dispersa("replay", out, "--case", 7)
        self.assertEqual(again.returncode, 0, again.stdout + again.stderr)

    def test_bytes_that_are_not_those_of_their_hash_are_refused(self):
        self.compile("hashed", SOURCE / "tests/plugins/law.c")
        out, ended = self.campaign_run("hashed", self.autopilot("hashed"), cases=1)
        self.assertEqual(ended.returncode, 3, ended.stderr)
        text = (out / "campaign.yaml").read_text()
        sha256 = hashlib.sha256((self.folder / "hashed.so").read_bytes()).hexdigest()
        self.assertIn(sha256, text)
        forged = self.folder / "forged.yaml"
        forged.write_text(text.replace(sha256, "f" * 64))
        checked = self.dispersa("validate", forged)
        self.assertEqual(checked.returncode, 2, checked.stderr)
        self.assertRegex(checked.stdout + checked.stderr, r"forged\.yaml:\d+:\d+: autopilot\.plugin\.library\.sha256: is not "
                         r"that of the bytes beside it, allowed: " + sha256)

    def test_another_object_is_another_flight_id(self):
        ids = set()
        for flags in ([], ["-DOTHER=1", "-g"]):
            self.compile("twin", SOURCE / "tests/plugins/law.c", flags=flags)
            out, ended = self.campaign_run(f"twin{len(ids)}", self.autopilot("twin"), cases=2)
            self.assertEqual(ended.returncode, 3, ended.stderr)
            ids.add(json.loads((out / "summary.json").read_text())["campaign"]["flight_id"])
        self.assertEqual(len(ids), 2)

    def test_telemetry_stands_in_histories(self):
        history = self.folder / "history.csv"
        flown = self.dispersa("fly", LOST, "--autopilot", self.law("PRINTS"), "--case", 1,
                              "--history", history)
        self.assertEqual(flown.returncode, 0, flown.stderr)
        head, *rows = (line.split(",") for line in history.read_text().splitlines())
        at = head.index("law_telemetry_1")
        self.assertEqual(rows[10][at], rows[10][head.index("time_s")])  # this law tells the time
        # What it prints is no result.
        self.assertNotIn("a law prints this", flown.stdout)
        self.assertIn("a law prints this", flown.stderr)

    def test_another_rounding_mode_does_not_last(self):
        self.assertEqual(self.run_cases("rounds_up", self.law("ROUNDS_UP")).read_bytes(), self.pd)

    # ---- what it may not do ----

    def quarantined(self, behaviour, reason, **options):
        """The run of a law that spoils one flight in four; the others have the built-in law's bytes."""
        out, ended = self.campaign_run(f"{behaviour}{options.get('workers', 0)}", self.law(behaviour), **options)
        self.assertEqual(ended.returncode, 5, ended.stderr)
        quarantined = json.loads((out / "summary.json").read_text())["quarantined"]
        self.assertGreater(len(quarantined), 0)
        for case in quarantined:
            self.assertRegex(case["reason"], "^the control law " + reason + r".* at 3\.0\d\d s, in stage 1$")
        cases = {case["case"] if "case" in case else case["case_index"] for case in quarantined}
        ours = (out / "cases.csv").read_text().splitlines()
        theirs = self.pd.decode().splitlines()
        self.assertEqual(ours, [row for row in theirs if not row.split(",")[0].isdigit()
                                or int(row.split(",")[0]) not in cases])
        with sqlite3.connect(f"file:{out}/results.sqlite?mode=ro", uri=True) as database:
            self.assertEqual(database.execute("SELECT count(*) FROM cases").fetchone()[0], CASES - len(cases))

    def test_a_crash_is_contained_and_named(self):
        self.quarantined("CRASHES", r"ended by signal 11 \(SIGSEGV\)")
        self.quarantined("CRASHES", r"ended by signal 11 \(SIGSEGV\)", workers=2)

    def test_a_share_that_lacks_a_case_says_so(self):
        out = self.folder / "out" / "share"
        ended = self.dispersa("run", LOST, "--autopilot", self.law("CRASHES"), "--cases", CASES, "--shard", "0/1",
                              "--out", out, "--quiet")
        self.assertEqual(ended.returncode, 5, ended.stderr)
        self.assertRegex(ended.stdout, rf"^share: \d+ of {CASES} cases flown, next: the same command with --resume\n")
        merged = self.dispersa("merge", out, "--out", self.folder / "out" / "merged", "--no-histories", "--quiet")
        self.assertEqual(merged.returncode, 5, merged.stderr)
        self.assertRegex(merged.stdout, r", \d+ quarantined\n")

    def test_the_end_of_the_process_is_contained(self):
        self.quarantined("ENDS", "ended the process with exit code 0")
        self.quarantined("ENDS", "ended the process with exit code 0", workers=2)

    def test_the_system_gives_a_law_no_socket_program_or_process(self):
        for behaviour, call in (("CONNECTS", "socket"), ("EXECUTES", "execve")):
            self.quarantined(behaviour, f"was refused the system call '{call}'")
        out, ended = self.campaign_run("forks", self.law("FORKS"))
        self.assertEqual(ended.returncode, 2, ended.stderr)
        # glibc of Debian 13 forks with all signals blocked: then nothing names the call.
        self.assertRegex(ended.stderr, r"the control law pd_test cannot fly the nominal flight: it (was refused the system call 'clone'|"
                                       r"ended by signal 31 \(SIGSYS\), after a system call that it may not make) "
                                       r"at 0\.0\d\d s, in stage 1\n$")
        self.assertFalse((out / "results.sqlite").exists())

    def test_a_law_reads_and_writes_no_file(self):
        held = json.loads(self.dispersa("--version", "--json").stdout)["sandbox"]
        self.assertTrue(held["seccomp"])
        users = self.folder / "users.txt"
        named = f'-DUSERS_FILE="{users}"'
        _, ended = self.campaign_run("writes", self.law("WRITES_A_FILE", named))
        self.assertEqual(ended.returncode, 2, ended.stderr)
        self.assertIn("it was refused the system call 'openat'\n", ended.stderr)
        self.assertFalse(users.exists())
        users.write_text("a secret\n")
        if held["landlock"]:
            self.assertEqual(self.run_cases("reads", self.law("READS_A_FILE", named)).read_bytes(), self.pd)

    def test_what_a_law_writes_into_its_pipe_is_bounded(self):
        self.quarantined("TALKS_WITHOUT_END", "answered with what is no result")

    def test_the_end_of_an_object_is_nobodys(self):
        self.assertEqual(self.run_cases("at_the_end", self.law("HANGS_AT_THE_END")).read_bytes(), self.pd)

    def test_one_that_waits_or_lets_go_of_its_files_is_contained(self):
        words = "did not return from a call within 2 s of computing or 5 s of waiting"
        for behaviour in ("SLEEPS", "CLOSES_FILES"):
            out, ended = self.campaign_run(behaviour, self.law(behaviour), cases=4, workers=2)
            self.assertEqual(ended.returncode, 5, ended.stderr)
            quarantined = json.loads((out / "summary.json").read_text())["quarantined"]
            self.assertGreater(len(quarantined), 0)
            for case in quarantined:
                self.assertIn(words, case["reason"])
            self.assertEqual(len((out / "cases.csv").read_text().splitlines()), 5 - len(quarantined))

    def test_what_a_law_throws_is_cut_and_on_one_line(self):
        source = self.folder / "throws.cc"
        source.write_text((SOURCE / "campaigns/control_laws/cpp/pid_filtered.cc").read_text().replace(
            "  static_cast<Law*>(memory)->Step(*input, *output);",
            '  if (input->time_s > 3) throw std::runtime_error(std::string(100000, 10));\n'
            "  static_cast<Law*>(memory)->Step(*input, *output);").replace(
                "#include <new>", "#include <new>\n#include <stdexcept>\n#include <string>"))
        self.compile("throws", source)
        flown = self.dispersa("fly", LOST, "--autopilot", self.autopilot(
            "throws", ", parameters: {integral_time_s: 2, filter_rad_s: 200}"))
        self.assertEqual(flown.returncode, 5, flown.stderr)
        self.assertRegex(flown.stderr, r"^the control law threw (\\x0a){250}\.\.\. at 3\.0\d+ s, in stage 1\n$")

    def test_what_a_law_says_of_itself_is_bounded_text(self):
        out, ended = self.campaign_run("steers", self.law("STEERS_THE_TERMINAL"), cases=2)
        self.assertEqual(ended.returncode, 3, ended.stderr)
        page = (out / "report.html").read_text()
        self.assertNotIn("<script>alert", page)  # on a terminal it is text
        shown = ended.stdout + ended.stderr + page
        for raw in ("\x1b", "\x07", "\x9b", "\u202e"):
            self.assertNotIn(raw, shown)
        said = html.unescape(shown)
        self.assertIn(r"\x1b]0;taken\x07<script>alert(1)</script>\x0a\xc2\x9b31m", said)
        self.assertIn(r"\xe2\x80\xae 1\x0d2 01234567890123456789012345678901234567890123...", said)

    def test_memory_without_bound_is_contained(self):
        self.quarantined("ALLOCATES", r"ended by signal 11 \(SIGSEGV\), in a process that may allocate 1024 MiB")

    def test_a_hang_is_contained(self):
        autopilot = self.law("HANGS")
        # A case that hangs takes its two seconds twice: once among others, once alone.
        out, ended = self.campaign_run("hangs", autopilot, cases=4)
        self.assertEqual(ended.returncode, 5, ended.stderr)
        for case in json.loads((out / "summary.json").read_text())["quarantined"]:
            self.assertRegex(case["reason"], r"^the control law did not return from a call within 2 s of computing")

    def test_failures_are_flights(self):
        for behaviour, reason in (("FAILS", "the plug-in's step failed"),
                                  ("COMMANDS_NAN", "the plug-in's pitch command is no finite number"),
                                  ("COMMANDS_INFINITY", "the plug-in's yaw command is no finite number"),
                                  ("DEFLECTS_FAR", "the plug-in's roll command is no finite number"),
                                  ("COMMANDS_MUCH", "the plug-in's pitch command is beyond 1e100 rad/s^2")):
            out, ended = self.campaign_run(behaviour, self.law(behaviour))
            self.assertEqual(ended.returncode, 3, ended.stderr)
            cases = (out / "cases.csv").read_text()
            self.assertEqual(len(cases.splitlines()), CASES + 1)
            failed = [row.split(",") for row in cases.splitlines() if ",numerical_failure," in row]
            self.assertTrue(0 < len(failed) < CASES)
            for row in failed:
                self.assertEqual(row[4], reason)
                self.assertAlmostEqual(float(row[2]), 3.0, delta=0.05)  # s: at once
            self.assertNotRegex(cases, r"(?i)\b(nan|inf)\b")
            self.assertIn(reason, (out / "report.html").read_text().replace("&#39;", "'"))

    def test_telemetry_that_is_no_number_is_an_empty_cell(self):
        autopilot = self.law("TELLS_NAN")
        self.assertEqual(self.run_cases("tells_nan", autopilot).read_bytes(), self.pd)
        history = self.folder / "tells_nan.csv"
        flown = self.dispersa("fly", LOST, "--autopilot", autopilot, "--history", history)
        self.assertEqual(flown.returncode, 0, flown.stderr)
        head, *rows = (line.split(",") for line in history.read_text().splitlines())
        self.assertEqual({row[head.index("law_telemetry_2")] for row in rows[2:20]}, {""})

    def test_what_is_not_deterministic_is_refused(self):
        for behaviour in ("READS_THE_CLOCK", "KEEPS_A_GLOBAL"):
            out, ended = self.campaign_run(behaviour, self.law(behaviour))
            self.assertEqual(ended.returncode, 2, ended.stderr)
            self.assertRegex(ended.stderr, r"the control law pd_test is not deterministic: of (the nominal flight|case "
                                           r"\d), flown twice, at \d+\.\d+ s \w+ is \S+ once and \S+ again")
            self.assertFalse((out / "results.sqlite").exists())

    def test_what_writes_beside_its_memory_is_refused(self):
        for behaviour, words in (("WRITES_BEFORE", r"wrote outside the memory of its flight, at \d+\.\d+ s at the latest, in stage 1"),
                                 ("WRITES_BEHIND", r"(wrote outside the memory of its flight, at 0|cannot fly the nominal flight: it "
                                                   r"ended by signal 11 \(SIGSEGV\))")):
            out, ended = self.campaign_run(behaviour, self.law(behaviour), campaign=WHOLE)
            self.assertEqual(ended.returncode, 2, ended.stderr)
            # On a busy machine a line before it says that the check goes on.
            self.assertRegex(ended.stderr, "(?m)^the control law pd_test " + words)
            self.assertFalse((out / "results.sqlite").exists())

    def test_a_slow_law_says_so_and_can_be_interrupted(self):
        for stop in (signal.SIGINT, signal.SIGTERM):
            log = self.folder / "slow.log"
            with open(log, "w") as stderr:
                run = subprocess.Popen([BINARIES / "dispersa", "run", WHOLE, "--autopilot", self.law("IS_SLOW"),
                                        "--out", self.folder / "out/slow"], stdout=stderr, stderr=stderr)
            self.addCleanup(run.kill)
            for _ in range(600):
                if "is checked before the campaign" in log.read_text():
                    break
                time.sleep(0.1)
            else:
                self.fail(log.read_text())
            run.send_signal(stop)
            self.assertEqual(run.wait(timeout=TIMEOUT_S), 130)
            self.assertIn("interrupted before the first case", log.read_text())

    def test_workers_that_all_refuse_it_end_the_run(self):
        programs = self.folder / "programs"
        programs.mkdir()
        for name in ("dispersa", "dispersa-foreign"):
            shutil.copy(BINARIES / name, programs)
        (programs / "dispersa-worker").write_text(f'#!/bin/sh\nulimit -n 777\nexec {BINARIES}/dispersa-worker "$@"\n')
        (programs / "dispersa-worker").chmod(0o755)
        self.enterContext(unittest.mock.patch.object(PluginTest, "programs", programs))
        for workers in (1, 2):
            _, ended = self.campaign_run(f"refused{workers}", self.law("CRASHES_IN_WORKERS"), workers=workers)
            self.assertEqual(ended.returncode, 5, ended.stderr)
            self.assertIn("no worker can fly this campaign: the control law pd_test cannot fly the nominal flight: it ended by "
                          "signal 6 (SIGABRT)", ended.stderr)

    def test_a_worker_alone_must_give_what_was_flown_here(self):
        _, ended = self.campaign_run("alone", self.law("DIFFERS_BY_WORKER"), workers=1)
        self.assertEqual(ended.returncode, 2, ended.stderr)
        self.assertRegex(ended.stderr, r"the control law pd_test is not deterministic: of case \d, flown here before the campaign and "
                                       r"again by \w+, metric_\w+ is '\S+' once and '\S+' again")

    def test_the_check_flies_each_flight_twice(self):
        _, ended = self.campaign_run("counts", self.law("COUNTS_FLIGHTS"))
        # The nominal flight and two cases, then the campaign.
        self.assertEqual(ended.stderr.count("a flight begins\n"), 2 * 3 + CASES)

    def test_one_that_always_crashes_is_refused_at_once(self):
        _, ended = self.campaign_run("always", self.law("CRASHES_ALWAYS"))
        self.assertEqual(ended.returncode, 2, ended.stderr)
        self.assertRegex(ended.stderr, r"the control law pd_test cannot fly the nominal flight: it ended by signal 6 \(SIGABRT\)"
                                       r".* at 3\.0\d+ s, in stage 1")

    def test_a_single_flight_that_crashes_says_so(self):
        autopilot = self.law("CRASHES_ALWAYS")
        flown = self.dispersa("fly", LOST, "--autopilot", autopilot)
        self.assertEqual(flown.returncode, 5)
        self.assertRegex(flown.stderr, r"^the control law ended by signal 6 \(SIGABRT\)")

    def test_files_that_are_no_laws(self):
        place = r"^\S+/bad\.yaml:2:19: plugin\.library: "
        allowed = r", allowed: a shared object with the functions of dispersa/control_law\.h\n$"
        self.compile("nothing", SOURCE / "core/control/control_law.h", flags=["-xc"])
        (self.folder / "text.so").write_text("no object\n")
        for name, words in (
                ("missing", r"file '\S+missing\.so' not found, "
                            r"allowed: a file, named relative to this one\n$"),
                ("text", "the control law cannot be loaded: file too short" + allowed),
                ("nothing", "the control law has no function 'dispersa_law_describe'" + allowed),
                ("other_abi", "the control law speaks version 77 of the interface of control laws, this program "
                              "version 1" + allowed),
                ("crashes_at_once", r"the control law ended by signal 6 \(SIGABRT\), in a process that may allocate "
                                    "1024 MiB" + allowed)):
            if name.upper() in BEHAVIOURS:
                self.law(name.upper())
            bad = self.folder / "bad.yaml"
            bad.write_text(PD.replace("law: pd", "law: plugin").replace(
                "tick_s:", f"tick_s:").replace("name: pd\n", f"plugin: {{library: {name}.so}}\nname: pd\n"))
            checked = self.dispersa("validate", bad)
            self.assertEqual(checked.returncode, 2)
            self.assertRegex(checked.stdout + checked.stderr, place + words)

    def test_a_plugin_is_the_law_of_some_axis(self):
        self.compile("pd", SOURCE / "campaigns/control_laws/c/pd.c", flags=["-std=c99"])
        bad = self.folder / "unused.yaml"
        bad.write_text(PD.replace("name: pd\n", "name: pd\nplugin: {library: pd.so}\n"))
        for command, file in (("validate", [bad]), ("fly", [LOST, "--autopilot", bad])):
            checked = self.dispersa(command, *file)
            self.assertEqual(checked.returncode, 2, checked.stderr)
            self.assertRegex(checked.stdout + checked.stderr,
                             r"\S+/unused\.yaml:3:9: (autopilot\.)?plugin: is the law of no axis, allowed: law: plugin of "
                             r"pitch, yaw or roll, or no plugin\n$")

    def test_parameters_are_checked(self):
        self.compile("pid_filtered", SOURCE / "campaigns/control_laws/cpp/pid_filtered.cc", flags=["-std=c++17"])
        path = self.autopilot("pid_filtered", ", parameters: {integral_time_s: 2, filter_rad: 200}")
        checked = self.dispersa("validate", path)
        self.assertEqual(checked.returncode, 2)
        self.assertIn("plugin.parameters.filter_rad: the unit of 'filter_rad' is not known here, allowed: filter_rad_s",
                      checked.stdout + checked.stderr)

    def test_commands_that_fly_here_refuse(self):
        self.compile("pd", SOURCE / "campaigns/control_laws/c/pd.c", flags=["-std=c99"])
        refused = self.dispersa("margins", LOST, "--autopilot", self.autopilot("pd"))
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("the control law is a plug-in, which flies in a child process; this command starts none",
                      refused.stderr)

    # ---- the installed interface ----

    def test_the_template_builds_against_an_installed_dispersa(self):
        prefix, laws = self.folder / "prefix", self.folder / "laws"
        build = pathlib.Path(os.environ["DISPERSA_BUILD"])
        subprocess.run(["cmake", "--install", build / "core/control", "--prefix", prefix], check=True,
                       capture_output=True, timeout=TIMEOUT_S)
        moved = self.folder / "moved"
        prefix.rename(moved)
        shutil.copytree(SOURCE / "campaigns/control_laws", laws)
        for command in (["cmake", "-S", laws, "-B", laws / "build", f"-DCMAKE_PREFIX_PATH={moved}"],
                        ["cmake", "--build", laws / "build"]):
            ended = subprocess.run(command, text=True, capture_output=True, timeout=TIMEOUT_S)
            self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        shutil.copy(laws / "build/pd.so", self.folder / "pd_template.so")
        self.assertEqual(self.run_cases("template", self.autopilot("pd_template")).read_bytes(), self.pd)
        # Only the interface is seen from outside.
        names = subprocess.run(["nm", "-D", "--defined-only", laws / "build/pid_filtered.so"], check=True, text=True,
                               capture_output=True).stdout
        self.assertEqual({line.split()[-1] for line in names.splitlines() if " T " in line},
                         {f"dispersa_law_{name}" for name in ("describe", "create", "start_stage", "step")})
        folder = next(moved.glob("**/pkgconfig"))
        flags = subprocess.run(["pkg-config", "--cflags", "dispersa"], check=True, text=True, capture_output=True,
                               env={**os.environ, "PKG_CONFIG_PATH": str(folder)}).stdout
        self.assertTrue((pathlib.Path(flags.strip()[2:]) / "dispersa/control_law.h").samefile(
            moved / "include/dispersa/control_law.h"))


if __name__ == "__main__":
    unittest.main()
