"""Streams of states and topics."""
import time

import msgpack
import zmq

from gloam_zmq.errors import GloamError
from gloam_zmq.image import image_array
from gloam_zmq.shared_ring import SharedRing

IMAGE = "sensor_msgs/msg/Image"


class Message:
    """One message of a stream.

    topic: its name, "/front/odom" or "state/100"; type: "nav_msgs/msg/Odometry" or "state"; step: physics step of its data;
    time: simulation time of its stamp [s]; delivery: when a real sensor's would have arrived [s]; sequence: number in its topic;
    sent_ns: CLOCK_MONOTONIC of the server's machine [ns]; data: a dict by the names of the fields (states: step, time, hash, qpos,
    qvel, ctrl), or bytes in CDR.
    """

    def __init__(self, topic, header, data, slot=None):
        self.topic, self.header, self.data = topic, header, data
        self.type, self.step, self.time = header["type"], header["step"], header["time"]
        self.delivery, self.sequence, self.sent_ns = header.get("delivery", self.time), header["sequence"], header["sent_ns"]
        self._slot = slot

    @property
    def is_valid(self):
        """False once the server has overwritten a message in shared memory: check after reading, and copy data that you keep."""
        if self._slot is None:
            return True
        ring, slot, sequence = self._slot
        return ring.sequence(slot) == sequence

    @property
    def is_shared(self):
        """Whether `data` lies in shared memory."""
        return self._slot is not None

    def image(self):
        """The picture as an array, (height, width) or (height, width, channels); a view, not a copy."""
        if self.type != IMAGE:
            raise TypeError(f"{self.topic} is not an image topic: its type is {self.type}")
        return image_array(self.data)[0]


class Stream:
    """An iterator over messages; close it, or use it in a with statement. One thread."""

    def __init__(self, socket, subscriptions, timeout=None):
        """subscriptions: {subscription: topic}; timeout: longest wait for a message [s], None = for ever."""
        self._socket, self._names, self.timeout = socket, subscriptions, timeout
        self._rings, self._last, self.lost = {}, {}, 0
        for subscription in subscriptions:
            socket.setsockopt(zmq.SUBSCRIBE, subscription.encode())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._socket.close(linger=0)
        self._rings.clear()

    def __iter__(self):
        return self

    def __next__(self):
        """Raises TimeoutError, and GloamError where the server has no such stream."""
        end = None if self.timeout is None else time.monotonic() + self.timeout
        while True:
            left = None if end is None else max(0, int(1000 * (end - time.monotonic())))
            if not self._socket.poll(left):
                raise TimeoutError(f"no message within {self.timeout} s")
            message = self._read(self._socket.recv_multipart(copy=False))
            if message is not None:
                return message

    def latest(self):
        """The newest message that waits of each topic, {topic: Message}; waits for nothing."""
        newest = {}
        while self._socket.poll(0):
            message = self._read(self._socket.recv_multipart(copy=False))
            if message is not None:
                newest[message.topic] = message
        return newest

    def _read(self, frames):
        if len(frames) != 3:
            return None
        subscription = frames[0].bytes.decode()
        topic = self._names.get(subscription)  # prefixes of others' subscriptions come, too
        if topic is None:
            return None
        header = msgpack.unpackb(frames[1].bytes)
        if header["type"] == "error":
            raise GloamError(header["error"])
        last = self._last.get(subscription)
        if last is not None and header["sequence"] > last + 1:
            self.lost += header["sequence"] - last - 1
        self._last[subscription] = header["sequence"]
        if "shm" in header:
            return self._read_shared(topic, header)
        if header["encoding"] == "msgpack":
            return Message(topic, header, msgpack.unpackb(frames[2].bytes))
        return Message(topic, header, frames[2].buffer)

    def _read_shared(self, topic, header):
        place = header["shm"]
        ring = self._rings.get(topic)
        if ring is None or ring[0] != place["name"]:
            try:
                ring = (place["name"], SharedRing(place["name"]))
            except FileNotFoundError:
                return None  # replaced by a larger one already
            self._rings[topic] = ring
        slot = (ring[1], place["slot"], place["sequence"])
        message = Message(topic, header, ring[1].view(place["offset"], place["bytes"]), slot)
        if not message.is_valid:
            self.lost += 1
            return None
        return message
