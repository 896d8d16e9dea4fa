"""Messages in POSIX shared memory, read where they stand. Layout: src/bridge/zmq/streams/shared_ring.h of Gloam, docs/zmq.md."""
import mmap
import os
import struct

_HEAD = struct.Struct("<8sIIQ")
_SLOT_HEADS, _SLOT_HEAD, _PAGE = 64, 16, 4096


class SharedRing:
    """A server's ring, mapped read-only."""

    def __init__(self, name):
        """name: "/gloam-zmq-…" of a message's header. Raises OSError where it cannot be opened."""
        descriptor = os.open("/dev/shm" + name, os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW)
        try:
            self._map = mmap.mmap(descriptor, os.fstat(descriptor).st_size, prot=mmap.PROT_READ)
        finally:
            os.close(descriptor)
        magic, version, self.slots, self.slot_bytes = _HEAD.unpack_from(self._map, 0)
        if magic != b"GLOAMSHM" or version != 1 or _PAGE + self.slots * self.slot_bytes > len(self._map):
            raise OSError(f"{name} is not a Gloam ring of this version")

    def sequence(self, slot):
        """Number of a slot's message; odd while it is written."""
        return struct.unpack_from("<Q", self._map, _SLOT_HEADS + slot * _SLOT_HEAD)[0]

    def view(self, offset, size):
        """The bytes of a message, not copied."""
        return memoryview(self._map)[offset:offset + size]
