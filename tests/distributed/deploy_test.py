"""Every deployment file is parsed, and every command in it runs: a coordinator and a worker that find each other.

Environment as of processes.py. Addresses, folders and ports are the test's; nothing else of a command is changed.
"""
import configparser
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import tempfile
import unittest
import urllib.request

import yaml

from processes import BINARIES, CAMPAIGN, PATIENCE_S, end, main, wait_for
from security_test import keys

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
DEPLOY = REPOSITORY / "services/deploy"


def unit(name):
    """The sections of a systemd unit; a repeated key keeps its last value."""
    parser = configparser.RawConfigParser(strict=False, comment_prefixes=("#",))
    parser.optionxform = str
    parser.read_string((DEPLOY / name).read_text())
    return parser


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

    def start(self, words, environment=None):
        """Starts a command of a file on loopback."""
        command = self.on_loopback(words)
        self.processes.append(subprocess.Popen(command, stderr=subprocess.DEVNULL, env={**os.environ, **(environment or {})}))
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
            self.assertEqual(urllib.request.urlopen(probe, timeout=PATIENCE_S).read(), b"ok\n")
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
