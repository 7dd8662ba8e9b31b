"""The templates for continuous integration, as far as they are shell: every step is run as the runner runs it, in a
repository with a campaign, with an installed dispersa.
"""
import os
import pathlib
import re
import shutil
import tempfile
import unittest
import xml.etree.ElementTree

from installed import SOURCE, environment, install, run

DEBIAN_PYTHON = "/usr/bin/python3"  # python3-yaml belongs to it


def read_yaml(file):
    import json
    done = run(DEBIAN_PYTHON, "-I", "-c", "import json, sys, yaml; print(json.dumps(yaml.safe_load(open(sys.argv[1]))))", file)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


class Pipelines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="dispersa-ci-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.prefix = cls.folder / "usr"
        install(cls.prefix)
        cls.templates = cls.prefix / "share/dispersa/campaigns/ci"

    def repository(self, limit):
        """Of somebody whose requirement is a peak pitch error below so many degrees."""
        root = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        for name in ("vehicles", "references", "autopilots"):
            shutil.copytree(SOURCE / "campaigns" / name, root / "campaigns" / name)
        text = (SOURCE / "campaigns/smoke.yaml").read_text()
        (root / "campaigns/mission.yaml").write_text(re.sub(r"below: [\d.]+", f"below: {limit}", text))
        return root

    def variables(self, template, **more):
        # Expressions are the runner's; a machine with dispersa needs no package.
        constants = {key: value for key, value in template.items() if not value.startswith("${{")}
        return environment(self.prefix, **{**constants, "GATE_ARGUMENTS": "--workers 0", "DISPERSA_PACKAGE": "", **more})

    def github(self, limit):
        """The job's result and its folder: a step after one that failed runs only `if: always()`."""
        template = read_yaml(self.templates / "github.yml")
        job = template["jobs"]["gate"]
        root = self.repository(limit)
        variables = self.variables(template["env"], GITHUB_STEP_SUMMARY=str(root / "summary.md"))
        code = 0
        for step in job["steps"]:
            if "run" not in step or (code != 0 and step.get("if") != "always()"):
                continue
            script = root / "step.sh"
            script.write_text(step["run"])
            self.assertEqual(job["defaults"]["run"]["shell"], "bash")
            done = run("bash", "--noprofile", "--norc", "-eo", "pipefail", script, cwd=root, env=variables)
            code = code or done.returncode
        upload = job["steps"][-1]
        self.assertEqual((upload["if"], upload["with"]["path"]), ("always()", "gate"))
        return code, root, done.stderr

    def gitlab(self, limit):
        template = read_yaml(self.templates / "gitlab.yml")
        job = template["dispersa"]
        root = self.repository(limit)
        done = run("bash", "-c", "set -eo pipefail\n" + "\n".join(job["before_script"] + job["script"]), cwd=root,
                   env=self.variables(template["variables"]))
        self.assertEqual((job["artifacts"]["when"], job["artifacts"]["paths"], job["artifacts"]["reports"]),
                         ("always", ["gate/"], {"junit": "gate/requirements.xml"}))
        self.assertEqual(job["allow_failure"], {"exit_codes": [4]})
        return done.returncode, root, done.stderr

    def failures(self, root):
        suite = xml.etree.ElementTree.parse(root / "gate/requirements.xml").getroot().find("testsuite")
        self.assertTrue((root / "gate/results/report.html").is_file())
        self.assertIn("# ", (root / "gate/report.md").read_text())
        return int(suite.get("failures"))

    def test_a_requirement_that_is_met_lets_pass(self):
        for flow in (self.github, self.gitlab):
            code, root, error = flow(limit=1)
            self.assertEqual((code, self.failures(root)), (0, 0), error)
            self.assertEqual(sorted(os.listdir(root / "gate")), ["dispersa-attempts.jsonl", "report.md", "requirements.xml", "results"])

    def test_one_that_is_not_stops_and_keeps_its_artifacts(self):
        for flow in (self.github, self.gitlab):
            code, root, error = flow(limit=1.0e-9)
            self.assertEqual((code, self.failures(root)), (3, 1), error)
        _, root, _ = self.github(limit=1.0e-9)
        self.assertIn("**fail**", (root / "summary.md").read_text())

    def test_a_campaign_that_is_wrong_stops_before_it_flies(self):
        for flow in (self.github, self.gitlab):
            code, root, _ = flow(limit="much")
            self.assertEqual(code, 2)
            self.assertFalse((root / "gate").exists())


if __name__ == "__main__":
    unittest.main()
