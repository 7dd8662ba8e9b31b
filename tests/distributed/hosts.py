"""Three hosts as network namespaces, joined by a bridge in this program's own, without multicast.

The links can be cut, or lose packets. Needs a network namespace of its own (processes.main).
"""
import os
import subprocess
import time

# Of whatever is started here: it ends with this program at the latest.
END_WITH_US = ["setpriv", "--pdeathsig", "KILL"]


def _run(*command):
    subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True)


class Host:
    def __init__(self, number):
        self.address = f"10.77.0.{number}"
        self.link = f"host{number}"
        self.holder = subprocess.Popen(["unshare", "-n", *END_WITH_US, "sleep", "infinity"])  # holds the namespace
        self.inside = ["nsenter", "-t", str(self.holder.pid), "-n"]
        while os.stat(f"/proc/{self.holder.pid}/ns/net").st_ino == os.stat("/proc/self/ns/net").st_ino:
            time.sleep(0.01)

    def join(self, bridge):
        _run("ip", "link", "add", self.link, "type", "veth", "peer", "name", "eth0", "netns", self.holder.pid)
        _run("ip", "link", "set", self.link, "master", bridge, "up")
        for command in (f"addr add {self.address}/24 dev eth0", "link set eth0 multicast off", "link set eth0 up",
                        "link set lo up"):
            _run(*self.inside, "ip", *command.split())
        for command in ("add table ip faults", "add chain ip faults in { type filter hook input priority 0 ; }",
                        "add chain ip faults out { type filter hook output priority 0 ; }"):
            _run(*self.inside, "nft", *command.split())

    def start(self, command, **options):
        return subprocess.Popen([*self.inside, *END_WITH_US, *map(str, command)], **options)

    def cut(self):
        _run("ip", "link", "set", self.link, "down")

    def drop(self, direction, percent, *packets):
        """Loses packets that come "in" or go "out" over the link; of these alone, if an expression of nft names some."""
        which = [] if percent == 100 else ["numgen", "random", "mod", "100", "<", percent]
        _run(*self.inside, "nft", "add", "rule", "ip", "faults", direction, "iif" if direction == "in" else "oif", "eth0",
             *packets, *which, "drop")

    def heal(self):
        _run("ip", "link", "set", self.link, "up")
        _run(*self.inside, "nft", "flush", "table", "ip", "faults")


class Hosts(list):
    """Ends with close()."""

    def __init__(self, count):
        super().__init__()
        _run("ip", "link", "add", "bridge", "type", "bridge")
        _run("ip", "link", "set", "bridge", "multicast", "off", "up")
        for number in range(1, count + 1):
            self.append(Host(number))
            self[-1].join("bridge")

    def close(self):
        for host in self:
            host.holder.kill()
            host.holder.wait()
        _run("ip", "link", "delete", "bridge")
