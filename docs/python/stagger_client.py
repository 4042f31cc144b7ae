"""Client of stagger's HTTP API and stream: one file, Python 3.9 or newer, the standard library alone.

    from stagger_client import Stagger
    robot = Stagger("http://127.0.0.1:8080", key=None)
    robot.push(direction_deg=90, impulse_ns=6, duration_s=0.05)
    for message in robot.stream(channels=["com", "dcm"], rate_hz=60):
        ...

Every method answers with the decoded JSON; what the server refuses becomes a StaggerError.
SI units; radians unless a name ends in _deg. docs/api.md and docs/stream.md tell the fields.
"""

import base64
import hashlib
import json
import os
import socket
import struct
import time
import urllib.error
import urllib.parse
import urllib.request
import uuid


class StaggerError(Exception):
    """What the server answered instead: `status`, `title`, `detail`, and `errors` by field."""

    def __init__(self, status, problem):
        self.status = status
        self.title = problem.get("title", "")
        self.detail = problem.get("detail", "")
        self.errors = problem.get("errors", [])
        fields = "".join(f"; {e['pointer']} {e['detail']}" for e in self.errors)
        super().__init__(f"{status} {self.title}: {self.detail}{fields}")


class Stagger:
    """One server. `key` is its API key, where it asks for one; `name` is who the events tell of."""

    def __init__(self, url="http://127.0.0.1:8080", key=None, name="python", timeout_s=330.0):
        self.url = url.rstrip("/")
        self.timeout_s = timeout_s
        self.headers = {"X-Stagger-Client": name}
        if key:
            self.headers["Authorization"] = "Bearer " + key

    def request(self, method, path, body=None, query=None):
        """Any route: `body` becomes JSON, or is sent as it is when it is (type, bytes)."""
        url = self.url + path + ("?" + urllib.parse.urlencode(query) if query else "")
        headers = dict(self.headers)
        data = None
        if isinstance(body, tuple):
            headers["Content-Type"], data = body
        elif body is not None:
            headers["Content-Type"] = "application/json"
            data = json.dumps(body, allow_nan=False).encode()
        request = urllib.request.Request(url, data=data, headers=headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=self.timeout_s) as answer:
                return _decoded(answer.headers.get_content_type(), answer.read())
        except urllib.error.HTTPError as error:
            with error:
                text = error.read()
            try:
                problem = json.loads(text)
            except ValueError:
                problem = {"detail": text.decode(errors="replace")}
            raise StaggerError(error.code, problem) from None

    # The simulation
    def state(self):
        return self.request("GET", "/api/v1/simulation")

    def pause(self):
        return self.request("POST", "/api/v1/simulation/pause")

    def resume(self):
        return self.request("POST", "/api/v1/simulation/resume")

    def step(self, ticks=1):
        """Runs that many ticks of a paused simulation, any number; answers when they are done."""
        effect = None
        while ticks > 0:
            effect = self.request("POST", "/api/v1/simulation/step", {"ticks": min(ticks, 10000)})
            ticks -= 10000
        return effect

    def reset(self, **fields):
        """robot, plant, seed, state, control_delay_ms, terrain: what is left out stays."""
        return self.request("POST", "/api/v1/simulation/reset", fields)

    # Walking
    def walk(self, vx=0.0, vy=0.0, wz=0.0):
        return self.request("POST", "/api/v1/walk", {"vx": vx, "vy": vy, "wz": wz})

    def stop(self):
        return self.request("POST", "/api/v1/stop")

    def strategies(self, **switches):
        """All of them; with ankle=False and the like, after that change."""
        if not switches:
            return self.request("GET", "/api/v1/strategies")
        return self.request("PATCH", "/api/v1/strategies", switches)

    # Pushes
    def push(self, **fields):
        """link, point, direction_deg or direction, impulse_ns or force_n, duration_s, ..."""
        return self.request("POST", "/api/v1/pushes", fields)

    def pushes(self):
        """All pushes of this session, newest first, page by page."""
        query = {"limit": 1000}
        while True:
            page = self.request("GET", "/api/v1/pushes", query=query)
            yield from page["items"]
            if page["next_cursor"] is None:
                return
            query["cursor"] = page["next_cursor"]

    def find_push(self, push_id):
        return self.request("GET", f"/api/v1/pushes/{int(push_id)}")

    def cancel_push(self, push_id):
        return self.request("DELETE", f"/api/v1/pushes/{int(push_id)}")

    # Robots
    def robots(self):
        return self.request("GET", "/api/v1/robots")["items"]

    def upload_robot(self, name, urdf, description=None, meshes=None, check=False):
        """`urdf`, `description`: text. `meshes`: path as in the URDF -> bytes. check: try it only."""
        boundary = uuid.uuid4().hex
        parts = [("name", None, name.encode()), ("urdf", None, urdf.encode())]
        if description:
            parts.append(("description", None, description.encode()))
        parts += [("mesh", path, data) for path, data in (meshes or {}).items()]
        body = b""
        for part, filename, data in parts:
            head = f'Content-Disposition: form-data; name="{part}"'
            if filename:
                head += f'; filename="{filename}"'
            body += f"--{boundary}\r\n{head}\r\n\r\n".encode() + data + b"\r\n"
        body += f"--{boundary}--\r\n".encode()
        kind = f"multipart/form-data; boundary={boundary}"
        query = {"check": "true"} if check else None
        return self.request("POST", "/api/v1/robots", (kind, body), query)

    def delete_robot(self, name):
        return self.request("DELETE", "/api/v1/robots/" + urllib.parse.quote(name, safe=""))

    # The stream
    def stream(self, channels=None, rate_hz=60, events=True, ticket=None):
        """Yields the stream's messages (dicts with `op`) until the server closes it.

        `ticket` goes into the address, where the server wants one of its own instead of the key.
        """
        socket_ = WebSocket(self.url, "/api/v1/stream" + (f"?ticket={ticket}" if ticket else ""),
                            self.headers)
        try:
            subscribe = {"op": "subscribe", "rate_hz": rate_hz, "events": events}
            if channels is not None:
                subscribe["channels"] = list(channels)
            socket_.send(json.dumps(subscribe))
            while True:
                text = socket_.receive()
                if text is None:
                    return
                yield json.loads(text)
        finally:
            socket_.close()


def _decoded(kind, body):
    if not body:
        return None
    return json.loads(body) if kind == "application/json" else body


class WebSocket:
    """As much of RFC 6455 as a client of text messages needs; http:// addresses alone."""

    def __init__(self, url, path, headers, timeout_s=30.0):
        parts = urllib.parse.urlsplit(url)
        if parts.scheme != "http":
            raise ValueError(f"the stream is reached over http, not {parts.scheme}")
        self.socket = socket.create_connection((parts.hostname, parts.port or 80), timeout_s)
        self.buffer = b""
        try:
            self._shake_hands(parts.netloc, path, headers)
        except BaseException:
            self.socket.close()
            raise

    def _shake_hands(self, host, path, headers):
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [f"GET {path} HTTP/1.1", f"Host: {host}", "Upgrade: websocket",
                 "Connection: Upgrade", f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"]
        lines += [f"{name}: {value}" for name, value in headers.items()]
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        while b"\r\n\r\n" not in self.buffer:
            self._fill()
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        first, *rest = head.decode("latin-1").split("\r\n")
        status = int(first.split()[1])
        fields = {name.lower(): value.strip()
                  for name, _, value in (line.partition(":") for line in rest)}
        if status != 101:
            body = self._take(int(fields.get("content-length", 0)))
            raise StaggerError(status, json.loads(body) if body else {"detail": first})
        magic = key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
        expected = base64.b64encode(hashlib.sha1(magic.encode()).digest()).decode()
        if fields.get("sec-websocket-accept") != expected:
            raise ConnectionError("what answered is no WebSocket server")

    def _fill(self):
        data = self.socket.recv(65536)
        if not data:
            raise ConnectionError("the server has gone")
        self.buffer += data

    def _take(self, count):
        while len(self.buffer) < count:
            self._fill()
        data, self.buffer = self.buffer[:count], self.buffer[count:]
        return data

    def _send_frame(self, opcode, payload):
        size = len(payload)
        head = bytes([0x80 | opcode])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 65536:
            head += bytes([0x80 | 126]) + struct.pack("!H", size)
        else:
            head += bytes([0x80 | 127]) + struct.pack("!Q", size)
        mask = os.urandom(4)
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))
        self.socket.sendall(head + mask + masked)

    def _receive_frame(self):
        first, second = self._take(2)
        size = second & 0x7F
        if size == 126:
            (size,) = struct.unpack("!H", self._take(2))
        elif size == 127:
            (size,) = struct.unpack("!Q", self._take(8))
        return bool(first & 0x80), first & 0x0F, self._take(size)

    def send(self, text):
        self._send_frame(0x1, text.encode())

    def receive(self):
        """The next text; None once the server has closed."""
        whole = b""
        while True:
            final, opcode, payload = self._receive_frame()
            if opcode == 0x8:
                self._send_frame(0x8, payload[:2])
                return None
            if opcode == 0x9:
                self._send_frame(0xA, payload)
            elif opcode in (0x0, 0x1, 0x2):
                whole += payload
                if final:
                    return whole.decode()

    def close(self):
        """Says goodbye and goes; what the server still sends is not waited for."""
        try:
            self._send_frame(0x8, struct.pack("!H", 1000))
        except OSError:
            pass
        self.socket.close()


def wait_until(condition, timeout_s=30.0, every_s=0.02):
    """Calls `condition` until it gives something true; that. TimeoutError when it does not."""
    end = time.monotonic() + timeout_s
    while True:
        result = condition()
        if result:
            return result
        if time.monotonic() > end:
            raise TimeoutError(f"not within {timeout_s} s")
        time.sleep(every_s)
