"""A client of Foxglove's WebSocket protocol by hand, on the standard library alone."""
import base64
import json
import os
import socket
import struct
import time


class Refused(Exception):
    """The server's HTTP answer to the handshake."""


class FoxgloveClient:
    """Connects by ws://HOST:PORT/?token=…; `protocols` in the order of preference."""

    def __init__(self, url, protocols=("foxglove.sdk.v1",), headers=()):
        host, _, target = url.removeprefix("ws://").partition("/")
        name, _, port = host.rpartition(":")
        self._socket = socket.create_connection((name, int(port)), 10)
        self._input = b""
        self.channels, self.services, self.info, self._id = {}, {}, None, 0
        self.told = None  # the last time that the server told [s]
        lines = [f"GET /{target} HTTP/1.1", f"Host: {host}", "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13",
                 f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}",
                 f"Sec-WebSocket-Protocol: {', '.join(protocols)}", *headers]
        self._socket.sendall("\r\n".join(lines).encode() + b"\r\n\r\n")
        while b"\r\n\r\n" not in self._input:
            self._input += self._receive(time.monotonic() + 10)
        answer, _, self._input = self._input.partition(b"\r\n\r\n")
        if not answer.startswith(b"HTTP/1.1 101"):
            self.close()
            raise Refused(answer.decode(errors="replace").splitlines()[0])
        while not (self.channels and self.services):
            self.next()

    def close(self):
        self._socket.close()

    def _receive(self, end):
        self._socket.settimeout(max(0.001, end - time.monotonic()))
        got = self._socket.recv(1 << 20)
        if not got:
            raise ConnectionError("the server has ended the connection")
        return got

    def _take(self, size, end):
        while len(self._input) < size:
            self._input += self._receive(end)
        taken, self._input = self._input[:size], self._input[size:]
        return taken

    def _send(self, opcode, payload):
        size = len(payload)
        head = struct.pack(">BB", 0x80 | opcode, 0x80 | size) if size < 126 else \
            struct.pack(">BBH", 0x80 | opcode, 0xFE, size) if size < 65536 else struct.pack(">BBQ", 0x80 | opcode, 0xFF, size)
        self._socket.sendall(head + bytes(4) + payload)

    def send(self, **message):
        self._send(1, json.dumps(message).encode())

    def send_binary(self, data):
        self._send(2, data)

    def next(self, seconds=20):
        """The next message: a dict of text, bytes of binary; what is advertised is kept in `channels` and `services`, by name."""
        end = time.monotonic() + seconds
        while True:
            opcode, size = self._take(2, end)
            size &= 127
            if size > 125:
                size = int.from_bytes(self._take(2 if size == 126 else 8, end), "big")
            payload = self._take(size, end)
            if opcode & 15 == 9:
                self._send(10, payload)
            elif opcode & 15 == 8:
                raise ConnectionError(payload[2:].decode())
            elif opcode & 15 == 2:
                if payload[0] == 2:
                    self.told = int.from_bytes(payload[1:9], "little") * 1e-9
                return payload
            else:
                message = json.loads(payload)
                self._keep(message)
                return message

    def _keep(self, message):
        if message["op"] == "serverInfo":
            self.info = message
        elif message["op"] == "advertise":
            schemas = {schema["id"]: schema for schema in message.get("schemas", [])}
            for channel in message["channels"]:
                if "schemaId" in channel:
                    schema = schemas[channel["schemaId"]]
                    channel |= {"schemaName": schema["name"], "schema": schema["data"], "schemaEncoding": schema["encoding"]}
                self.channels[channel["topic"]] = channel
        elif message["op"] == "advertiseServices":
            self.services |= {service["name"]: service for service in message["services"]}

    def wait(self, fits, seconds=20):
        end = time.monotonic() + seconds
        while True:
            message = self.next(max(0.001, end - time.monotonic()))
            if (found := fits(message)) is not None:
                return found

    def wait_for(self, op, seconds=20):
        return self.wait(lambda m: m if isinstance(m, dict) and m["op"] == op else None, seconds)

    def subscribe(self, topic):
        self._id += 1
        self.send(op="subscribe", subscriptions=[{"id": self._id, "channelId": self.channels[topic]["id"]}])
        return self._id

    def unsubscribe(self, subscription):
        self.send(op="unsubscribe", subscriptionIds=[subscription])

    def data(self, subscription, seconds=60):
        """(time [ns], payload) of the next message of a subscription."""
        def fits(message):
            if isinstance(message, bytes) and message[0] == 1:
                number, stamp = struct.unpack_from("<IQ", message, 1)
                if number == subscription:
                    return stamp, message[13:]
            return None
        return self.wait(fits, seconds)

    def time(self, seconds=20):
        """The next time that the server tells [s]."""
        return self.wait(lambda m: struct.unpack_from("<Q", m, 1)[0] * 1e-9 if isinstance(m, bytes) and m[0] == 2 else None, seconds)

    def until(self, seconds_told, seconds=20):
        """The last time that the server told [s], once it is that late; it may have come before another answer."""
        end = time.monotonic() + seconds
        while self.told is None or self.told < seconds_told:
            self.next(max(0.001, end - time.monotonic()))
        return self.told

    def call(self, service, request=None, seconds=60):
        """The response of a service, in JSON."""
        self._id += 1
        number, call, text = self.services[service]["id"], self._id, json.dumps(request or {}).encode()
        self.send_binary(struct.pack("<BIII", 2, number, call, 4) + b"json" + text)

        def fits(message):
            if isinstance(message, dict):
                if message["op"] == "serviceCallFailure" and message["callId"] == call:
                    raise RuntimeError(message["message"])
            elif message[0] == 3 and struct.unpack_from("<I", message, 5)[0] == call:
                return json.loads(message[17:])
            return None
        return self.wait(fits, seconds)

    def advertise(self, topic, schema, encoding="json"):
        self._id += 1
        self.send(op="advertise", channels=[{"id": self._id, "topic": topic, "encoding": encoding, "schemaName": schema}])
        return self._id

    def publish(self, channel, message):
        payload = message if isinstance(message, bytes) else json.dumps(message).encode()
        self.send_binary(struct.pack("<BI", 1, channel) + payload)

    def parameters(self, *names):
        self.send(op="getParameters", parameterNames=list(names), id="get")
        return {p["name"]: p["value"] for p in self.wait_for("parameterValues")["parameters"]}

    def set_parameter(self, name, value):
        self.send(op="setParameters", parameters=[{"name": name, "value": value}], id="set")
        return self.wait_for("parameterValues")

    def control_playback(self, play, speed=1.0, seek=None):
        """Plays or pauses a log; the state that comes as an answer: (status, time [s], speed, did seek)."""
        self._id += 1
        request = str(self._id).encode()
        seek_ns = 0 if seek is None else round(1e9 * seek)
        self.send_binary(struct.pack("<BBfBQI", 3, 0 if play else 1, speed, seek is not None, seek_ns, len(request)) + request)
        return self.wait(lambda m: parse_state(m) if isinstance(m, bytes) and m[0] == 5 and m[19:] == request else None)

    def playback_state(self, seconds=20):
        return self.wait(lambda m: parse_state(m) if isinstance(m, bytes) and m[0] == 5 else None, seconds)


def parse_state(message):
    status, stamp, speed, seeks = struct.unpack_from("<BQfB", message, 1)
    return ["playing", "paused", "buffering", "ended"][status], stamp * 1e-9, speed, bool(seeks)
