"""Requests without end, slow ones and many, to every page that the product serves: web application, Prometheus.

A good request is answered meanwhile, and the program's memory stays as it is. Environment as of processes.py.
"""
import http.client
import os
import pathlib
import re
import select
import socket
import stat
import subprocess
import sys
import time

from processes import CAMPAIGN, ISOLATED, PATIENCE_S, main, wait_for
from service_case import ServiceCase

WEB, FIGURES = 9475, 9476
TOKEN = "0123456789abcdef"
MORE_KB = 16 * 1024    # memory that a server may take under attack
FLOOD_S = float(os.environ.get("DISPERSA_FLOOD_S", "0.5"))          # for which an attacker sends as fast as it can
ANSWERED_S = 1.0       # a good request meanwhile
REQUEST_S = 8.0        # until every connection of an attacker is closed: 5 s and a loaded machine
CROWD = 1000
NOBODY = 65534


def resident_kb(process):
    return int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{process.pid}/status").read_text()).group(1))


def peak_kb(process):
    return int(re.search(r"VmHWM:\s+(\d+)", pathlib.Path(f"/proc/{process.pid}/status").read_text()).group(1))


def connect(port):
    connection = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)
    connection.setblocking(False)
    return connection


def send(connection, data):
    """False: the server has closed."""
    try:
        connection.send(data)
        return True
    except BlockingIOError:
        return True
    except OSError:
        return False


def is_closed(connection):
    """What the server has sent is read and dropped."""
    try:
        while connection.recv(65536):
            pass
        return True
    except BlockingIOError:
        return False
    except OSError:
        return True


class HostileHttpTest(ServiceCase):
    DOMAIN = "33"

    def setUp(self):
        super().setUp()
        token = self.root / f"{self.data.name}.token"
        token.write_text(TOKEN + "\n")
        token.chmod(0o600)
        coordinator = self.start("dispersa-coordinator", "--data", self.data, "--web", WEB, "--web-token", token, "--metrics", FIGURES)
        self.dispersa("launch", CAMPAIGN)
        # Port, the program behind it, a page to send to, a page that a good reader gets.
        self.servers = {"web": (WEB, coordinator, "/login", "/"), "figures": (FIGURES, coordinator, "/metrics", "/metrics")}
        for name in self.servers:
            wait_for(lambda name=name: self.answers(name), name)

    def start_another(self, *arguments, **options):
        """A coordinator beside the first."""
        self.NETWORK = ["--domain", "34", "--address", "127.0.0.1"]
        return self.start("dispersa-coordinator", *arguments, **options)

    def answers(self, name):
        try:
            return self.status_of(name) == 200  # figures are there a moment after the page
        except OSError:
            return False

    def status_of(self, name):
        port, _, _, path = self.servers[name]
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
        connection.request("GET", path, headers={"Authorization": "Bearer " + TOKEN})
        answer = connection.getresponse()
        answer.read()
        connection.close()
        return answer.status

    def good_request_s(self, name):
        """How long a good request takes."""
        begun = time.monotonic()
        self.assertEqual(self.status_of(name), 200, name)
        return time.monotonic() - begun

    def attack(self, title, each):
        """each(name, port, page): attacks one server. Its memory stays, and it answers."""
        for name, (port, process, page, _) in self.servers.items():
            pathlib.Path(f"/proc/{process.pid}/clear_refs").write_text("5")  # the peak from now on
            before = resident_kb(process)
            answered_s = each(name, port, page)
            more = peak_kb(process) - before
            print(f"{title}, {name}: +{more / 1024:.1f} MB, a good request meanwhile {answered_s:.3f} s", file=sys.stderr)
            with self.subTest(title, server=name):
                self.assertLess(more, MORE_KB)
                self.assertLess(answered_s, ANSWERED_S)
                self.assertIsNone(process.poll())

    def flood(self, head, block):
        def each(name, port, page):
            begun, answered_s = time.monotonic(), 0.0
            while time.monotonic() < begun + FLOOD_S:
                with connect(port) as connection:
                    connection.settimeout(0.2)
                    try:
                        connection.sendall(head.replace(b"PAGE", page.encode()))
                        while time.monotonic() < begun + FLOOD_S:
                            connection.sendall(block)
                    except OSError:
                        pass  # refused: once more
                    answered_s = max(answered_s, self.good_request_s(name))
            return answered_s
        return each

    def test_bodies_and_headers_without_end(self):
        head = b"POST PAGE HTTP/1.1\r\nHost: localhost\r\n"
        self.attack("chunks without end", self.flood(head + b"Transfer-Encoding: chunked\r\n\r\n", b"10000\r\n" + b"a" * 65536 + b"\r\n"))
        self.attack("chunks of a GET", self.flood(head.replace(b"POST", b"GET") + b"Transfer-Encoding: chunked\r\n\r\n",
                                                 b"10000\r\n" + b"a" * 65536 + b"\r\n"))
        self.attack("chunk extension without end", self.flood(head + b"Transfer-Encoding: chunked\r\n\r\n1;", b"a" * 65536))
        self.attack("trailers without end", self.flood(head + b"Transfer-Encoding: chunked\r\n\r\n0\r\n", b"a: b\r\n" * 10000))
        self.attack("a long body", self.flood(head + b"Content-Length: 999999999999\r\n\r\n", b"a" * 65536))
        self.attack("headers without end", self.flood(head, b"X-A: " + b"a" * 1000 + b"\r\n"))
        self.attack("small headers without end", self.flood(head, b"a:b\r\n" * 10000))
        self.attack("a header without end", self.flood(head + b"X-A: ", b"a" * 65536))
        self.attack("a request line without end", self.flood(b"GET /", b"a" * 65536))
        self.attack("empty lines without end", self.flood(b"", b"\r\n" * 30000))

    def test_slow_ones_are_closed_and_block_nobody(self):
        """A byte every 2 s, of a header, of a body and of nothing, for as long as the server lets it."""
        def each(name, port, page):
            heads = [b"GET %s HTTP/1.1\r\nHost: localhost\r\nX-Slow: " % page.encode(),
                     b"POST %s HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n" % page.encode(), b"G"]
            connections = [connect(port) for _ in range(48)]
            for index, connection in enumerate(connections):
                send(connection, heads[index % 3])
            begun, longest, spoken = time.monotonic(), 0.0, 0.0
            while not all(is_closed(connection) for connection in connections):
                if time.monotonic() > spoken + 2:
                    spoken = time.monotonic()
                    for connection in connections:
                        send(connection, b"a")
                longest = max(longest, self.good_request_s(name))
                time.sleep(0.1)
                if time.monotonic() > begun + REQUEST_S:
                    longest = 99
                    break
            for connection in connections:
                connection.close()
            return longest
        self.attack("a byte every 2 s", each)

    def test_a_slow_reader_blocks_nobody(self):
        """One that reads no answer."""
        def each(name, port, page):
            connections = []
            for _ in range(48):
                connection = socket.socket()
                connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1024)
                connection.connect(("127.0.0.1", port))
                connection.sendall(b"GET /style.css HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer %s\r\n\r\n" % TOKEN.encode())
                connections.append(connection)
            longest = self.good_request_s(name)
            for connection in connections:
                connection.close()
            return longest
        self.attack("48 that do not read", each)

    def test_a_crowd(self):
        """A thousand connections that say nothing, and a thousand that begin a request."""
        def each(begin):
            def attack(name, port, page):
                connections, longest = [], 0.0
                for index in range(CROWD):
                    connection = socket.socket()
                    connection.setblocking(False)
                    connection.connect_ex(("127.0.0.1", port))
                    connections.append(connection)
                    if index % 200 == 199:
                        select.select([], [connection], [], 1)
                        for other in connections[-200:]:
                            send(other, begin)
                        longest = max(longest, self.good_request_s(name))
                process = self.servers[name][1]
                open_files = len(os.listdir(f"/proc/{process.pid}/fd"))
                self.assertLess(open_files, 300)
                for connection in connections:
                    connection.close()
                return longest
            return attack
        self.attack("1000 that say nothing", each(b""))
        self.attack("1000 that begin", each(b"GET / HTTP/1.1\r\nHost: local"))

    def test_no_peer_takes_the_places_of_another(self):
        """Users on loopback, addresses elsewhere: 300 connections of one leave those of the other."""
        if os.geteuid() != 0 or ISOLATED not in os.environ:
            self.skipTest("needs another user, and addresses of its own")
        for address in ("198.51.100.1", "198.51.100.2"):
            subprocess.run(["ip", "address", "add", f"{address}/32", "dev", "lo"], check=True)
        figures = self.start_another("--data", self.root / "open", "--metrics", f"0.0.0.0:{FIGURES + 10}")
        self.servers["open"] = (FIGURES + 10, figures, "/metrics", "/metrics")
        wait_for(lambda: self.answers("open"), "figures on all addresses")

        def from_address(address):
            connection = socket.socket()
            connection.bind((address, 0))
            return connection, ("198.51.100.1", FIGURES + 10)

        def from_user(user):
            os.seteuid(user)
            try:
                return socket.socket(), ("127.0.0.1", FIGURES)
            finally:
                os.seteuid(0)
        for peer_of, good, bad in ((from_address, "198.51.100.1", "198.51.100.2"), (from_user, 0, NOBODY)):
            connection, server = peer_of(good)
            connection.connect(server)
            crowd = []
            for _ in range(300):
                other, _ = peer_of(bad)
                other.settimeout(PATIENCE_S)
                other.connect(server)
                crowd.append(other)
            # Connections are accepted in turn: when the later one has its answer, the whole crowd was accepted.
            later, _ = peer_of(good)
            later.connect(server)
            for good_one in (connection, later):
                good_one.sendall(b"GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n")
                good_one.settimeout(PATIENCE_S)
                self.assertTrue(good_one.recv(100).startswith(b"HTTP/1.1 200 "), good)
                good_one.close()
            open_ones = 0
            for other in crowd:
                other.setblocking(False)
                open_ones += not is_closed(other)
                other.close()
            self.assertLessEqual(open_ones, 8)

    def test_pages_are_their_owners_alone(self):
        """Without a token no other user of this machine reads them."""
        if os.geteuid() != 0:
            self.skipTest("only root can ask as another user")
        own = self.start_another("--data", self.root / "own", "--web", WEB + 10)
        self.servers["own"] = (WEB + 10, own, "/", "/")
        wait_for(lambda: self.answers("own"), "pages without a token")

        def as_nobody(port, path, family=socket.AF_INET, host="127.0.0.1"):
            """A socket belongs to the user that made it."""
            os.seteuid(NOBODY)
            try:
                connection = socket.socket(family)
            finally:
                os.seteuid(0)
            connection.settimeout(PATIENCE_S)
            connection.connect((host, port))
            connection.sendall(f"GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
            answer = b""
            while part := connection.recv(65536):
                answer += part
            connection.close()
            return answer.decode().partition(" ")[2]
        answer = as_nobody(WEB + 10, "/")
        self.assertTrue(answer.startswith("403 "), answer)
        self.assertNotIn("smoke", answer)
        self.assertTrue(as_nobody(WEB + 10, "/", socket.AF_INET6, "::ffff:127.0.0.1").startswith("403 "))
        self.assertTrue(as_nobody(FIGURES, "/metrics").startswith("200 "))
        self.assertIn("Sign in", as_nobody(WEB, "/login"))

    def test_data_are_the_owners_alone(self):
        data = self.root / "fresh" / "data"
        coordinator = self.start_another("--data", data, umask=0o022)
        wait_for(lambda: (data / "epoch").exists() or coordinator.poll() is not None, "its data")
        for path in [self.data, *self.data.rglob("*"), data, *data.rglob("*")]:
            mode = stat.S_IMODE(path.stat().st_mode)
            self.assertEqual(mode & 0o077, 0, f"{path} {mode:o}")


if __name__ == "__main__":
    main()
