"""A browser for tests: Chromium without a window, through chromedriver; nothing leaves the loopback interface."""
import base64
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

KEYS = {"Tab": "\ue004", "Enter": "\ue007", "Escape": "\ue00c", "End": "\ue010", "Home": "\ue011", "ArrowLeft": "\ue012",
        "ArrowUp": "\ue013", "ArrowRight": "\ue014", "ArrowDown": "\ue015"}
DRIVER = shutil.which(sys.argv[1])
DISPERSA, CAMPAIGN = map(os.path.abspath, sys.argv[2:4])


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Browser:
    """A session of chromedriver."""

    def __init__(self, chromedriver, folder):
        port = free_port()
        self.base = f"http://127.0.0.1:{port}"
        self.driver = subprocess.Popen([chromedriver, f"--port={port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(200):
            try:
                if self.call("GET", "/status")["ready"]:
                    break
            except OSError:
                time.sleep(0.05)
        options = {
            "goog:chromeOptions": {
                "args": ["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1400,1000",
                         f"--user-data-dir={folder}"]
            }
        }
        self.base += "/session/" + self.call("POST", "/session", {"capabilities": {"alwaysMatch": options}})["sessionId"]

    def call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data=data, method=method)
        with urllib.request.urlopen(request, timeout=60) as answer:
            return json.load(answer)["value"]

    def open(self, url):
        self.call("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def devtools(self, command, **parameters):
        return self.call("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def pointer(self, *steps):
        """Steps: (x, y) to move there, "down", "up"."""
        actions = []
        for step in steps:
            if step in ("down", "up"):
                actions.append({"type": "pointer" + step.capitalize(), "button": 0})
            else:
                actions.append({"type": "pointerMove", "duration": 20, "x": round(step[0]), "y": round(step[1])})
        self.call("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": actions}]})

    def keys(self, *keys):
        """Names of KEYS, one after the other."""
        actions = [{"type": kind, "value": KEYS[key]} for key in keys for kind in ("keyDown", "keyUp")]
        self.call("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def pages_of_print(self):
        """Of the open page on paper of the size that it asks for."""
        pdf = base64.b64decode(self.devtools("Page.printToPDF", preferCSSPageSize=True, printBackground=False)["data"])
        return len(re.findall(rb"/Type\s*/Page\b", pdf))

    def close(self):
        try:
            self.call("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait(timeout=20)


class BrowserCase(unittest.TestCase):
    """Tests that share one browser and a temporary folder."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.browser = Browser(DRIVER, os.path.join(cls.temporary.name, "profile"))

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.temporary.cleanup()


class ServiceCase(BrowserCase):
    """Tests of pages that programs of this build serve. `network` are these programs' options of the domain."""

    network = []
    patience_s = 60

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=self.temporary.name))
        self.processes = []

    def tearDown(self):
        for process in self.processes:
            if process.poll() is None:
                process.kill()
            process.wait()

    def start(self, program, *arguments):
        with (self.folder / "log").open("a") as log:
            self.processes.append(subprocess.Popen([pathlib.Path(DISPERSA).parent / program, *map(str, arguments), *self.network],
                                                   stdout=log, stderr=log))
        return self.processes[-1]

    def text(self):
        return self.browser.run("return document.body.innerText")

    def wait_for(self, condition, what):
        deadline = time.monotonic() + self.patience_s
        while not condition():
            if time.monotonic() > deadline:
                self.fail(f"{what}: not within {self.patience_s} s\n{self.text()}\n{(self.folder / 'log').read_text()[-2000:]}")
            time.sleep(0.1)


def main():
    """What each of these programs ends with: PROGRAM CHROMEDRIVER DISPERSA CAMPAIGN [ARGUMENT...]."""
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
