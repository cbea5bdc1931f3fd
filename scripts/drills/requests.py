"""Hostile requests to the studio, on loopback: wrong tokens and hosts, broken heads, endless bodies, hasty clients."""
import http.client
import os
import random
import re
import signal
import socket
import subprocess
import threading
import time

from . import running

MOST = 20000  # requests in all, whatever the time


class Studio:
    """A studio on a free port, ended with the drill."""

    def __init__(self, bench):
        self.place = bench.copy()
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        self.process = subprocess.Popen([bench.program, "studio", "design.toml", "--folder", "desk", "--port", "0", "--no-open"],
                                        cwd=self.place, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True)
        address = self.process.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)/([0-9a-f]+)/", address)
        if not found:
            raise SystemExit(f"torture: the studio gave no address: {address!r}")
        self.port, self.token = int(found[1]), found[2]

    def memory(self):
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as status:
            return int(re.search(r"VmRSS:\s+(\d+)", status.read())[1]) << 10

    def page(self):
        """Whether the page still comes, within five seconds."""
        try:
            connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=5)
            connection.request("GET", f"/{self.token}/")
            return connection.getresponse().status == 200
        except OSError:
            return False

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        try:
            return self.process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return None


def hostile(source, studio):
    """The bytes of one hostile request."""
    host = f"Host: 127.0.0.1:{studio.port}\r\n"
    own = f"/{studio.token}/"
    body = source.choice(["{", "[]", '{"a":' * 2000, "null", '"\\ud800"', "{}" * 500, "\0" * 100, '{"values": {"texture.depth": 1e999}}'])
    kinds = [
        f"GET /{'0' * 32}/ HTTP/1.1\r\n{host}\r\n",
        f"GET {own} HTTP/1.1\r\nHost: evil.example\r\n\r\n",
        f"GET {own}../../etc/passwd HTTP/1.1\r\n{host}\r\n",
        f"GET {own}files/..%2f..%2fetc%2fpasswd HTTP/1.1\r\n{host}\r\n",
        f"POST {own}{source.choice(['values', 'save', 'search', 'open', 'export', 'pin', 'undo', 'nothing'])} HTTP/1.1\r\n{host}"
        f"Origin: http://127.0.0.1:{studio.port}\r\nContent-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n{body}",
        f"POST {own}values HTTP/1.1\r\n{host}Origin: http://evil.example\r\nContent-Length: 2\r\n\r\n{{}}",
        f"POST {own}values HTTP/1.1\r\n{host}Content-Length: 99999999999\r\n\r\n{body}",
        f"POST {own}values HTTP/1.1\r\n{host}Content-Length: -1\r\n\r\n{body}",
        f"PUT {own}values HTTP/1.1\r\n{host}Transfer-Encoding: chunked\r\n\r\n" + ("10000\r\n" + "x" * 65536 + "\r\n") * 16,
        f"GET {own} HTTP/1.1\r\n{host}" + "X: y\r\n" * 3000 + "\r\n",
        "GET " + "/" * source.randint(1, 100000) + " HTTP/1.1\r\n\r\n",
        "".join(chr(source.randrange(256)) for _ in range(source.randint(1, 400))),
        f"GET {own} HTTP/1.1\r\n{host}Range: bytes=0-,1-,2-,-5\r\n\r\n",
        f"GET {own}events HTTP/1.1\r\n{host}\r\n",
    ]
    return source.choice(kinds).encode("latin-1")


def hasty(studio, seed, end, counts):
    """One client: sends, at times reads a little, hangs up."""
    source = random.Random(seed)
    while time.monotonic() < end and sum(counts) < MOST:
        counts[seed] += 1
        try:
            with socket.create_connection(("127.0.0.1", studio.port), timeout=2) as line:
                request = hostile(source, studio)
                line.sendall(request[:source.randint(1, len(request))] if source.random() < 0.2 else request)
                line.settimeout(0.05)
                if source.random() < 0.7:
                    line.recv(4096)
        except OSError:
            pass


def drill(bench, seconds):
    tally = running.Tally("hostile requests")
    studio = Studio(bench)
    try:
        before = studio.memory()
        end = time.monotonic() + seconds
        counts = [0] * 8
        clients = [threading.Thread(target=hasty, args=(studio, k, end, counts)) for k in range(len(counts))]
        for client in clients:
            client.start()
        for client in clients:
            client.join()
        tally.count("requests", sum(counts))
        time.sleep(2)  # the last bodies are still on their way
        if studio.process.poll() is not None:
            tally.faults.append(f"the studio ended with {studio.process.returncode}")
        else:
            if not studio.page():
                tally.faults.append("the page no longer comes")
            grown = studio.memory() - before
            tally.count("MB more memory", grown >> 20)
            if grown > 256 << 20:
                tally.faults.append(f"memory grew by {grown >> 20} MB")
    finally:
        status = studio.end()
    if status is None:
        tally.faults.append("the studio did not end within 20 s of a request to end")
    return tally
