"""Every deployment file is parsed, and every command in it runs: a coordinator and a worker that find each other.

Environment as of processes.py. Addresses, folders and ports are the test's; nothing else of a command is changed.
"""
import configparser
import ctypes
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
import urllib.error
import urllib.request

import yaml

from processes import BINARIES, BRIEF, CAMPAIGN, PATIENCE_S, Run, end, main, wait_for
from security_test import keys

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
DEPLOY = REPOSITORY / "services/deploy"
WORST_EXPOSURE = 3.0  # of systemd-analyze security, from 0 to 10; 7.9 without the unit's limits
WRITES_A_FILE = 32    # of tests/plugins/law.c
EPERM, ENOSYS, EAFNOSUPPORT = 1, 38, 97
WRITE_EXECUTE, EXECUTE, SHM_EXECUTE = 6, 4, 0o100000
OTHER_NAMESPACES = (0x20000, 0x2000000, 0x4000000, 0x8000000, 0x20000000)  # mounts, cgroup, host name, IPC, processes
OTHER_FAMILIES = (10, 17)  # IPv6, packets


def unit(name):
    """The sections of a systemd unit; a repeated key keeps its last value."""
    parser = configparser.RawConfigParser(strict=False, comment_prefixes=("#",))
    parser.optionxform = str
    parser.read_string((DEPLOY / name).read_text())
    return parser


def answers_ok(probe):
    try:
        return urllib.request.urlopen(probe, timeout=PATIENCE_S).read() == b"ok\n"
    except urllib.error.HTTPError:
        return False


def calls_of(names):
    """The system calls of a SystemCallFilter=, groups resolved as systemd does."""
    calls = set()
    for name in names:
        if name.startswith("@"):
            said = subprocess.run(["systemd-analyze", "--no-pager", "syscall-filter", name], capture_output=True, text=True, check=True)
            calls |= calls_of(line.strip() for line in said.stdout.splitlines()[1:] if line.strip() and "#" not in line)
        else:
            calls.add(name)
    return calls


class Compared(ctypes.Structure):
    """libseccomp's scmp_arg_cmp."""
    _fields_ = [("arg", ctypes.c_uint), ("op", ctypes.c_int), ("a", ctypes.c_uint64), ("b", ctypes.c_uint64)]


def filters_of(file):
    """A function for a child that puts the filters of a unit on it: those of SystemCallFilter=, MemoryDenyWriteExecute=,
    RestrictNamespaces= and RestrictAddressFamilies=. Prepared here: between fork and exec little is safe."""
    text = (DEPLOY / file).read_text()
    lists = re.findall(r"(?m)^SystemCallFilter=(.*)$", text)
    allowed = calls_of(lists[0].split()) - calls_of(lists[1].removeprefix("~").split())
    assert "MemoryDenyWriteExecute=yes" in text and "RestrictNamespaces=user net\n" in text
    assert "RestrictAddressFamilies=AF_INET AF_UNIX AF_NETLINK\n" in text
    library = ctypes.CDLL("libseccomp.so.2")
    library.seccomp_init.restype = ctypes.c_void_p

    def added(filter_, action, call, *compared):
        number = library.seccomp_syscall_resolve_name(call.encode())
        if number >= 0:  # else one of another architecture or kernel
            values = (Compared * len(compared))(*compared)
            assert library.seccomp_rule_add_array(ctypes.c_void_p(filter_), action, number, len(compared), values) == 0, call

    allow, refuse = 0x7FFF0000, 0x00050000
    lists = library.seccomp_init(refuse | EPERM)
    for call in sorted(allowed):
        added(lists, allow, call)
    rules, masked, equal = library.seccomp_init(allow), 7, 4
    added(rules, refuse | EPERM, "mmap", Compared(2, masked, WRITE_EXECUTE, WRITE_EXECUTE))
    added(rules, refuse | EPERM, "shmat", Compared(2, masked, SHM_EXECUTE, SHM_EXECUTE))
    for call in ("mprotect", "pkey_mprotect"):
        added(rules, refuse | EPERM, call, Compared(2, masked, EXECUTE, EXECUTE))
    for call in ("unshare", "clone"):
        for flag in OTHER_NAMESPACES:
            added(rules, refuse | EPERM, call, Compared(0, masked, flag, flag))
    added(rules, refuse | ENOSYS, "clone3")
    for family in OTHER_FAMILIES:
        added(rules, refuse | EAFNOSUPPORT, "socket", Compared(0, equal, family, 0))

    def load():
        for each in (rules, lists):
            assert library.seccomp_load(ctypes.c_void_p(each)) == 0
    return load


class DeployTest(unittest.TestCase):
    def setUp(self):
        self.data = tempfile.mkdtemp(prefix="dispersa-deploy-")
        self.authority = pathlib.Path(self.data, "authority")
        keys("init", self.authority)
        self.keys = {program: keys("issue", self.authority, "--role", role, "--name", "one") for program, role in
                     (("dispersa-coordinator", "coordinator"), ("dispersa-worker", "worker"), ("dispersa", "client"))}
        self.processes = []

    def tearDown(self):
        end(self.processes)
        shutil.rmtree(self.data)

    def start(self, words, **options):
        """Starts a command of a file on loopback."""
        self.processes.append(subprocess.Popen(self.on_loopback(words), **{"stderr": subprocess.DEVNULL, **options}))
        return self.processes[-1]

    def on_loopback(self, words):
        """The command with the folders, keys and peer of this test. Each must name keys."""
        words = [str(word) for word in words]
        program = pathlib.Path(words[0]).name
        words[words.index("--keys") + 1] = self.keys[program]
        for option, value in (("--data", f"{self.data}/data"), ("--peer", "127.0.0.1"), ("--slots", "1")):
            if option in words:
                words[words.index(option) + 1] = value
        return [BINARIES / program, *words[1:], "--address", "127.0.0.1"]

    def assert_they_find_each_other(self, coordinator, worker, probe):
        def workers():
            status = subprocess.run(self.on_loopback(["dispersa", "status", "--domain", "0", "--keys", "/keys"]),
                                    capture_output=True, text=True)
            return "worker " in status.stdout
        self.start(coordinator)
        worker = self.start(worker) if isinstance(worker, list) else worker()
        wait_for(workers, "a worker")
        if isinstance(probe, str):
            wait_for(lambda: answers_ok(probe), "a ready coordinator")  # a kubelet asks again, too
        else:
            self.assertEqual(subprocess.run(self.on_loopback(probe), timeout=PATIENCE_S).returncode, 0)
        worker.send_signal(signal.SIGTERM)
        self.assertEqual(worker.wait(timeout=PATIENCE_S), 0)

    def test_images_have_the_version_as_their_tag(self):
        version = re.search(r"project\(dispersa VERSION (\S+)", (REPOSITORY / "CMakeLists.txt").read_text()).group(1)
        for name in ("services/deploy/kubernetes.yaml", "docker/compose.yaml", "docker/Dockerfile", "docker/README.md"):
            images = re.findall(r"(?m)(?:image: |build -t |data/results\" )(\S+)", (REPOSITORY / name).read_text())
            self.assertEqual(set(images), {f"dispersa:{version}"}, name)

    def test_compose(self):
        compose = yaml.safe_load((REPOSITORY / "docker/compose.yaml").read_text())
        services = compose["services"]
        self.assertEqual(set(services), {"coordinator", "worker"})
        self.assertEqual(services["coordinator"]["healthcheck"]["test"][0], "CMD")
        for name, service in services.items():
            self.assertRegex(" ".join(service["volumes"]), rf"/issued/{name}-\w+:/keys:ro\b")
        self.assert_they_find_each_other(shlex.split(services["coordinator"]["command"]),
                                         shlex.split(services["worker"]["command"]),
                                         services["coordinator"]["healthcheck"]["test"][1:])
        # The campaign that the file's head tells to launch, with the keys that are mounted there.
        head = (REPOSITORY / "docker/compose.yaml").read_text()
        launch = shlex.split(re.search(r"exec coordinator (dispersa launch .*)", head).group(1))
        launch[launch.index("CAMPAIGN")] = CAMPAIGN
        launch[launch.index("--keys") + 1] = self.keys["dispersa-coordinator"]
        launched = subprocess.run([BINARIES / launch[0], *launch[1:], "--address", "127.0.0.1"], capture_output=True,
                                  text=True, timeout=PATIENCE_S)
        self.assertRegex(launched.stdout, "^[0-9a-f]{64}\n$", launched.stderr)

    def test_kubernetes(self):
        documents = {(d["kind"], d["metadata"]["name"]): d["spec"] for d in yaml.safe_load_all((DEPLOY / "kubernetes.yaml").read_text())}
        sets = [name for kind, name in documents if kind == "StatefulSet"]
        self.assertEqual(sets, ["dispersa-coordinator", "dispersa-worker"])
        coordinators, workers = (documents["StatefulSet", name]["template"] for name in sets)
        coordinator, worker = (template["spec"]["containers"][0] for template in (coordinators, workers))
        # Names that must agree.
        for name in sets:
            self.assertIn(("Service", documents["StatefulSet", name]["serviceName"]), documents)
        self.assertEqual(worker["command"][worker["command"].index("--peer") + 1],
                         f"dispersa-coordinator-0.{documents['StatefulSet', 'dispersa-coordinator']['serviceName']}")
        scaled = documents["HorizontalPodAutoscaler", "dispersa-worker"]
        self.assertEqual([scaled["scaleTargetRef"][key] for key in ("kind", "name")], ["StatefulSet", "dispersa-worker"])
        for name, template in zip(sets, (coordinators, workers)):
            self.assertEqual(documents["StatefulSet", name]["selector"]["matchLabels"], template["metadata"]["labels"])
            pod = template["spec"]
            mounts = {mount["name"]: mount["mountPath"] for mount in pod["containers"][0]["volumeMounts"]}
            self.assertEqual(pod["containers"][0]["command"][pod["containers"][0]["command"].index("--keys") + 1], mounts["keys"])
            # Readable for the user of the container and nobody else.
            self.assertEqual([volume["secret"]["defaultMode"] for volume in pod["volumes"] if "secret" in volume], [0o440])
            self.assertEqual(pod["securityContext"]["fsGroup"], 1000)
        self.assert_pods_may_little(documents, {"dispersa-coordinator": coordinators["spec"], "dispersa-worker": workers["spec"]})
        self.assert_each_pod_has_its_own_keys(workers["spec"], scaled["maxReplicas"])
        # As a monitor elsewhere in the cluster: not from the loopback address that the program would take by itself.
        address, port = coordinator["command"][coordinator["command"].index("--metrics") + 1].split(":")
        probes = {kind: coordinator[f"{kind}Probe"]["httpGet"] for kind in ("readiness", "liveness")}
        self.assertEqual(probes, {"readiness": {"path": "/readyz", "port": "metrics"},
                                  "liveness": {"path": "/healthz", "port": "metrics"}})
        self.assert_they_find_each_other(coordinator["command"], worker["command"], f"http://127.0.0.3:{port}/readyz")
        self.assertEqual(urllib.request.urlopen(f"http://127.0.0.3:{port}/healthz", timeout=PATIENCE_S).read(), b"ok\n")
        self.assertEqual(address, "0.0.0.0")
        for annotation, value in (("scrape", "true"), ("port", port), ("path", "/metrics")):
            annotations = coordinators["metadata"]["annotations"]
            self.assertEqual(annotations[f"prometheus.io/{annotation}"], value)
        self.assertEqual({p["name"]: p["containerPort"] for p in coordinator["ports"]}, {"metrics": int(port)})
        metrics = urllib.request.urlopen(f"http://127.0.0.3:{port}/metrics", timeout=PATIENCE_S).read().decode()
        self.assertIn(f"\n{scaled['metrics'][0]['external']['metric']['name']} 0\n", metrics)
        for line in metrics.splitlines():
            self.assertRegex(line, r'^(# (HELP|TYPE) dispersa_\w+ .+|dispersa_\w+(\{\w+="[^"]*"(,\w+="[^"]*")*\})? [\d.e+-]+)$')

    def assert_pods_may_little(self, documents, pods):
        for name, pod in pods.items():
            self.assertEqual(pod["securityContext"], {"runAsNonRoot": True, "runAsUser": 1000, "fsGroup": 1000,
                                                      "seccompProfile": {"type": "RuntimeDefault"}})
            self.assertIs(pod["automountServiceAccountToken"], False)
            for container in pod["containers"] + pod.get("initContainers", []):
                self.assertEqual(container["securityContext"], {"allowPrivilegeEscalation": False, "readOnlyRootFilesystem": True,
                                                                "capabilities": {"drop": ["ALL"]}}, container["name"])
            policy = documents["NetworkPolicy", name]
            self.assertEqual(policy["podSelector"]["matchLabels"], {"app": name})
            self.assertEqual(policy["policyTypes"], ["Ingress", "Egress"])
            self.assertTrue(all(rule["from"] and rule["ports"] for rule in policy["ingress"]), "nobody may all")
        # Who speaks with whom: both ends of each way, at every port of the domain.
        ports = {"protocol": "UDP", "port": 7400, "endPort": 7649}
        ways = {(name, way, peer["podSelector"]["matchLabels"]["app"]) for name in pods for way, side in (("ingress", "from"), ("egress", "to"))
                for rule in documents["NetworkPolicy", name][way] if ports in rule["ports"] for peer in rule[side]
                if "app" in peer["podSelector"]["matchLabels"]}
        self.assertEqual(ways, {("dispersa-coordinator", "ingress", "dispersa-worker"), ("dispersa-coordinator", "egress", "dispersa-worker"),
                                ("dispersa-worker", "ingress", "dispersa-coordinator"), ("dispersa-worker", "egress", "dispersa-coordinator")})
        budget = documents["PodDisruptionBudget", "dispersa-worker"]
        self.assertEqual((budget["maxUnavailable"], budget["selector"]["matchLabels"]), ("25%", {"app": "dispersa-worker"}))

    def assert_each_pod_has_its_own_keys(self, pod, number):
        """The commands of the file's head make a secret, of which the init container takes what is its pod's."""
        self.assertEqual([mount["name"] for mount in pod["containers"][0]["volumeMounts"]], ["keys"])
        head = re.sub(r"(?m)^# ?", "", (DEPLOY / "kubernetes.yaml").read_text().partition("apiVersion")[0])
        issue, create = re.search(r"(for n in .*)\n +(kubectl create secret generic dispersa-worker-keys (?s:.*?done\)))", head).groups()
        script = f'dispersa() {{ "{BINARIES}/dispersa" "$@"; }}; {issue}; kubectl() {{ printf "%s\\n" "$@"; }}; {create}'
        words = subprocess.run(["bash", "-ec", script], cwd=self.data, capture_output=True, text=True, check=True).stdout
        all_keys = pathlib.Path(self.data, "all-keys")
        all_keys.mkdir()
        for file, source in re.findall(r"(?m)^--from-file=(.*?)=(.*)$", words):
            shutil.copy(pathlib.Path(self.data, source), all_keys / file)
        for n in range(number):
            own = pathlib.Path(self.data, f"keys-{n}")
            own.mkdir()
            init = [word.replace("/all-keys", str(all_keys)).replace('"/keys', f'"{own}') for word in pod["initContainers"][0]["command"]]
            subprocess.run(init, check=True, env={**os.environ, "POD": f"dispersa-worker-{n}"})
            issued = self.authority / f"issued/worker-dispersa-worker-{n}"
            self.assertEqual({file.name: file.read_bytes() for file in own.iterdir()},
                             {file.name: file.read_bytes() for file in issued.iterdir()})

    def test_systemd(self):
        coordinator, worker = unit("dispersa-coordinator.service"), unit("dispersa-worker.service")
        variables = dict(word.split("=", 1) for word in worker["Service"]["Environment"].split())
        command = worker["Service"]["ExecStart"]
        for name in ("dispersa-coordinator", "dispersa-worker"):
            loaded = re.findall(r"(?m)^LoadCredential=(.*):/etc/dispersa/keys/(.*)$", (DEPLOY / f"{name}.service").read_text())
            self.assertEqual({file for file, _ in loaded}, {file.name for file in self.keys[name].iterdir()})
            self.assertTrue(all(shown == file for shown, file in loaded))
        for name, value in variables.items():
            command = command.replace("${" + name + "}", value)
        self.assertNotIn("$", command)
        self.assertEqual((coordinator["Service"]["Restart"], worker["Service"]["Restart"]), ("always", "always"))
        self.assert_they_find_each_other(shlex.split(coordinator["Service"]["ExecStart"]), shlex.split(command),
                                         ["dispersa-coordinator", "--health", "--domain", "0", "--keys", "%d"])

    def test_units_leave_an_attacker_little(self):
        for name in ("dispersa-coordinator", "dispersa-worker"):
            said = subprocess.run(["systemd-analyze", "--no-pager", "security", "--offline=true", DEPLOY / f"{name}.service"],
                                  capture_output=True, text=True, check=True, env={**os.environ, "LC_ALL": "C.UTF-8"})
            exposure = float(re.search(r"Overall exposure level for \S+: ([\d.]+) ", said.stdout).group(1))
            self.assertLess(exposure, WORST_EXPOSURE, said.stdout)
            service = unit(f"{name}.service")["Service"]
            for key, value in (("UMask", "0077"), ("CapabilityBoundingSet", ""), ("NoNewPrivileges", "yes")):
                self.assertEqual(service[key], value)
            self.assertIn("MemoryMax", service)

    def law(self, behaviour):
        """An autopilot that is a shared object: a PD, of which tests/plugins/law.c says what it does besides."""
        include = pathlib.Path(self.data, "dispersa")
        include.mkdir(exist_ok=True)
        shutil.copy(REPOSITORY / "core/control/control_law.h", include)
        library = pathlib.Path(self.data, f"law{behaviour}.so")
        subprocess.run(["gcc", "-O2", "-fPIC", "-shared", f"-DDISPERSA_MISBEHAVES={behaviour}",
                        f'-DUSERS_FILE="{self.data}/written"', f"-I{self.data}", REPOSITORY / "tests/plugins/law.c", "-lm", "-o", library], check=True, timeout=PATIENCE_S)
        autopilot = library.with_suffix(".yaml")
        autopilot.write_text((REPOSITORY / "tests/data/brief/pd.yaml").read_text().replace("law: pd", "law: plugin").replace(
            "tick_s:", f"plugin: {{library: {library.name}}}\ntick_s:"))
        return autopilot

    def test_units_fly_plug_ins_in_their_sandbox(self):
        """Under the units' filters a good law flies to the bytes of a run, and one that opens a file is refused as ever."""
        reference = Run(pathlib.Path(self.data, "reference"), "--workers", 0, "--cases", 2, "--autopilot", self.law(0),
                        campaign=BRIEF).finish()
        for name in ("coordinator", "worker"):
            command = shlex.split(unit(f"dispersa-{name}.service")["Service"]["ExecStart"].replace("${SLOTS}", "1"))
            with pathlib.Path(self.data, f"{name}.log").open("w") as log:
                self.start([*command, "--allow-plugins"], stderr=log, preexec_fn=filters_of(f"dispersa-{name}.service"))

        def asks(*words):
            return subprocess.run(self.on_loopback(["dispersa", *words, "--keys", "/keys"]), capture_output=True, text=True,
                                  timeout=PATIENCE_S)
        identity = asks("launch", reference.out / "campaign.yaml").stdout.strip()
        self.assertEqual(asks("watch", identity).returncode, reference.code, self.logs())
        self.assertEqual(asks("fetch", identity, "--out", f"{self.data}/fetched").returncode, 0)
        self.assertEqual(pathlib.Path(self.data, "fetched/cases.csv").read_bytes(), reference.csv())
        bad = pathlib.Path(self.data, "bad.yaml")
        bad.write_text(f"schema: dispersa/campaign/1\nname: bad\nbased_on: {BRIEF}\nautopilot: {self.law(WRITES_A_FILE)}\n")
        refused = asks("launch", bad)
        self.assertIn("it was refused the system call 'openat'", refused.stderr + refused.stdout, self.logs())
        self.assertFalse(pathlib.Path(self.data, "written").exists())

    def test_units_keep_every_part_of_the_sandbox(self):
        """A plug-in flies without these where a kernel lacks them, so nobody would see that a filter took one away."""
        parts = """import ctypes, os
libc = ctypes.CDLL(None, use_errno=True)
call = lambda *words: libc.syscall(*(ctypes.c_long(word) for word in words))
print("landlock", call(444, 0, 0, 1))
text = ctypes.create_string_buffer(b"x")
there, here = (ctypes.c_void_p * 2)(ctypes.addressof(text), 1), (ctypes.c_void_p * 2)(ctypes.addressof(ctypes.create_string_buffer(1)), 1)
print("look at a path", libc.process_vm_readv(os.getpid(), here, 1, there, 1, 0))
print("seccomp", call(317, 2, 0, ctypes.addressof(ctypes.create_string_buffer((0x7fff0000).to_bytes(4, "little")))))
print("namespaces", libc.unshare(0x10000000 | 0x40000000))"""
        command = [sys.executable, "-c", parts]
        free = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        self.assertEqual(len(free.splitlines()), 4)
        for name in ("coordinator", "worker"):
            shut = subprocess.run(command, capture_output=True, text=True, check=True,
                                  preexec_fn=filters_of(f"dispersa-{name}.service")).stdout
            self.assertEqual(shut, free)

    def logs(self):
        return "".join(log.read_text() for log in pathlib.Path(self.data).glob("*.log"))

    def test_slurm(self):
        script = DEPLOY / "slurm.sbatch"
        self.assertEqual(subprocess.run(["bash", "-n", script]).returncode, 0)
        missing = subprocess.run(["bash", script], capture_output=True, text=True, env={"PATH": os.environ["PATH"]})
        self.assertNotEqual(missing.returncode, 0)
        self.assertIn("COORDINATOR: name of the host where dispersa-coordinator runs", missing.stderr)

        def submitted():
            environment = {**os.environ, "PATH": f"{BINARIES}:{os.environ['PATH']}", "COORDINATOR": "127.0.0.1",
                           "DISPERSA_KEYS": str(self.authority / "issued"), "SLURMD_NODENAME": "one"}
            self.processes.append(subprocess.Popen(["bash", script], env=environment, stderr=subprocess.DEVNULL))
            return self.processes[-1]
        self.assert_they_find_each_other(["dispersa-coordinator", "--data", self.data, "--keys", "/keys"], submitted,
                                         ["dispersa-coordinator", "--health", "--keys", "/keys"])


if __name__ == "__main__":
    main()
