"""The half without the service (DISPERSA_SERVICE=OFF): built, flown, packed, and beside the package of the cluster."""
import os
import pathlib
import re
import shutil
import tempfile
import unittest

from installed import BUILD, CMAKE, CPACK, SOURCE, environment, run

PATIENCE_S = 1500
PYTHON = "/usr/bin/python3"
NO_SERVICE = "this build has no service (DISPERSA_SERVICE=OFF)"
# Of the service alone.
ABSENT = re.compile(r"fastrtps|fastcdr|fastdds|seccomp|libssl")


class EngineHalf(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.build = BUILD.parent / f"{BUILD.name}-engine"  # not in BUILD, whose worker Python would find; incremental
        cls.bin = cls.build / "bin"
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-engine-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        for command in ((CMAKE, "-G", "Ninja", "-S", SOURCE, "-B", cls.build, "-D", "CMAKE_BUILD_TYPE=Release", "-D",
                         "DISPERSA_SERVICE=OFF", "-D", "DISPERSA_WARNINGS_AS_ERRORS=ON"), (CMAKE, "--build", cls.build)):
            done = run(*command, timeout=PATIENCE_S)
            assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]

    def dispersa(self, *arguments, program=None):
        return run(program or self.bin / "dispersa", *arguments, cwd=self.folder)

    def test_needs_no_library_of_the_service(self):
        python, = (self.build / "python/dispersa").glob("_core*.so")
        for file in (self.bin / "dispersa", python):
            needed = run("readelf", "--dynamic", file).stdout
            self.assertIn("libyaml-cpp", needed)
            self.assertIsNone(ABSENT.search(needed), file)
        self.assertEqual(os.listdir(self.bin), ["dispersa"])

    def test_gives_the_bytes_of_the_whole_product(self):
        for name in ("table3", "table3_flexible"):
            both = []
            for program, how in ((self.bin / "dispersa", ()), (self.bin / "dispersa", ("--workers", 0, "--threads", 1)),
                                 (BUILD / "bin/dispersa", ("--workers", 2))):
                out = self.folder / f"{name}-{len(both)}"
                done = self.dispersa("run", SOURCE / f"campaigns/{name}.yaml", "--cases", 24, "--no-histories", "--quiet", "--out", out,
                                     *how, program=program)
                self.assertIn(done.returncode, (0, 3, 4), done.stderr)
                both.append([(out / file).read_bytes() for file in ("cases.csv", "summary.json")])
            self.assertEqual(both[0], both[1])
            self.assertEqual(both[0], both[2])

    def test_says_what_it_has_not(self):
        smoke = SOURCE / "campaigns/smoke.yaml"
        done = self.dispersa("run", smoke, "--workers", 2)
        self.assertEqual((done.returncode, done.stderr),
                         (2, f"--workers: {NO_SERVICE}, allowed: --workers 0 and --threads N\n"))
        self.assertFalse((self.folder / "results").exists())
        for words in (("launch", smoke, "--peer", "nowhere"), ("status",), ("keys", "--help"), ("keys", "issue", "a", "--role", "client")):
            done = self.dispersa(*words)
            self.assertEqual((done.returncode, done.stderr),
                             (2, f"{words[0]}: {NO_SERVICE}, allowed: the package dispersa-cluster beside it, or a build with "
                                 "DISPERSA_SERVICE=ON\n"))
        for listing in (self.dispersa("--help").stdout, self.dispersa("completion", "words", "").stdout):
            self.assertIn("replay", listing)
            self.assertNotRegex(listing, r"(?m)^ *(launch|watch|keys)\b")
        # A folder of a coordinator is no folder that it knows.
        (self.folder / "data").mkdir(exist_ok=True)
        (self.folder / "data/epoch").write_text("1\n")
        self.assertIn("allowed: a result folder\n", self.dispersa("fsck", "data").stderr)
        # A shared object is not loaded: nothing shuts it in.
        (self.folder / "include/dispersa").mkdir(parents=True, exist_ok=True)
        shutil.copy(SOURCE / "core/control/control_law.h", self.folder / "include/dispersa")
        made = run("gcc", "-std=c99", "-O2", "-fPIC", "-shared", f"-I{self.folder}/include", SOURCE / "campaigns/control_laws/c/pd.c",
                   "-lm", "-o", self.folder / "pd.so")
        self.assertEqual(made.returncode, 0, made.stderr)
        pd = (SOURCE / "tests/data/brief/pd.yaml").read_text()
        (self.folder / "pd.yaml").write_text(pd.replace("law: pd", "law: plugin").replace("tick_s:", "plugin: {library: pd.so}\ntick_s:"))
        done = self.dispersa("run", SOURCE / "campaigns/table3.yaml", "--autopilot", "pd.yaml", "--cases", 2, "--out", "plugin")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertRegex(done.stderr, r"pd\.yaml:\d+:\d+: plugin\.library: the control law is a shared object, and this build has "
                                      r"no sandbox for one \(DISPERSA_SERVICE=OFF\)")

    def test_python_flies(self):
        text = ("import dispersa, sys\n"
                "results = dispersa.run(sys.argv[1], 'of_python', cases=8, histories=False)\n"
                "print(len(results.cases), dispersa.worker_program())\n"
                "try:\n  dispersa.run(sys.argv[1], 'remote', peer='nowhere')\n"
                "except dispersa.BadInput as error:\n  print(error)\n"
                "try:\n  dispersa.run(sys.argv[1], 'workers', workers=2)\n"
                "except dispersa.BadInput as error:\n  print(error)\n")
        done = run(PYTHON, "-B", "-c", text, SOURCE / "campaigns/table3.yaml", cwd=self.folder,
                   env={"PATH": "/usr/bin:/bin", "HOME": str(self.folder), "PYTHONPATH": str(self.build / "python")})
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = done.stdout.splitlines()
        self.assertEqual(lines[0], "8 None")
        self.assertIn(f"peer: {NO_SERVICE}", lines[1])
        self.assertIn(f"workers: {NO_SERVICE}", lines[2])

    @unittest.skipUnless(shutil.which("dpkg-shlibdeps"), "not a Debian system (tests/packages.txt)")
    def test_two_packages_make_the_whole(self):
        root = self.folder / "root"
        of = {}
        for name, config in (("dispersa-engine", self.build / "CPackConfig.cmake"), ("dispersa-cluster", BUILD / "CPackClusterConfig.cmake")):
            done = run(CPACK, "--config", config, "-G", "DEB", "-B", self.folder / name, "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip",
                       cwd=self.folder)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            package, = (self.folder / name).glob(f"{name}_*.deb")
            of[name] = {field: run("dpkg-deb", "--field", package, field).stdout.strip() for field in ("Package", "Depends", "Conflicts", "Version")}
            files = {line.split(maxsplit=5)[5] for line in run("dpkg-deb", "--contents", package).stdout.splitlines() if line[0] != "d"}
            of[name]["files"] = files
            self.assertEqual(run("dpkg-deb", "--extract", package, root).returncode, 0)
            if name == "dispersa-engine":
                self.assertEqual(run(root / "usr/bin/dispersa", "status").returncode, 2)
        engine, cluster = of["dispersa-engine"], of["dispersa-cluster"]
        self.assertEqual(engine["files"] & cluster["files"], set())
        self.assertNotRegex(engine["Depends"], "fastrtps|fastcdr|fastdds|seccomp")  # libssl3 has libcrypto
        self.assertIn(f"dispersa-engine (= {engine['Version']})", cluster["Depends"])
        self.assertRegex(cluster["Depends"], r"libfast(rtps2\.9|dds3\.1)\b")
        self.assertEqual((engine["Conflicts"], cluster["Conflicts"]), ("dispersa", "dispersa"))
        self.assertEqual({file for file in cluster["files"] if "/bin/" in file},
                         {f"./usr/bin/dispersa-{name}" for name in ("coordinator", "worker", "foreign", "fleet")})
        # Together they fly with workers. In a folder of their own: attempts at the same vehicle count.
        (self.folder / "alone").mkdir()
        done = run(root / "usr/bin/dispersa", "run", root / "usr/share/dispersa/campaigns/smoke.yaml", "--workers", 1, "--quiet",
                   "--no-histories", "--out", self.folder / "alone/together", env=environment(root / "usr"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("launch", run(root / "usr/bin/dispersa", "--help").stdout)


if __name__ == "__main__":
    unittest.main()
