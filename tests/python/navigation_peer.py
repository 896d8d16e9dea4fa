"""The other side of `[planner] type = "external"` for tests: answers as it is told, from a thread."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from typing import Any

import zmq

Reply = list[bytes] | None  # None: no reply


class Peer:
    """Answers the calls of one planner. plan(k): the parts of the reply to the k-th "plan", from 0."""

    def __init__(self, address: str, plan: Callable[[int], Reply], describe: Any = None, reset: Any = None) -> None:
        self.address, self.calls, self.plans = address, list[str](), 0
        self._plan = plan
        self._fixed = {"describe": {"needs": []} if describe is None else describe, "reset": {} if reset is None else reset}
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.ROUTER)  # unlike REP, it may leave requests without a reply
        self._socket.setsockopt(zmq.LINGER, 0)
        self._socket.bind(address)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while not self._stop.is_set():
            if not self._socket.poll(20):
                continue
            client, empty, header, *_ = self._socket.recv_multipart()
            call = json.loads(header)["call"]
            self.calls.append(call)
            reply = [json.dumps(self._fixed[call]).encode()] if call in self._fixed else self._plan(self.plans)
            self.plans += call == "plan"
            if reply is not None:
                self._socket.send_multipart([client, empty, *reply])
        self._socket.close()
        self._context.term()

    def __enter__(self) -> Peer:
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()
