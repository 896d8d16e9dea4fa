"""Client of a running Gloam simulation over ZeroMQ (docs/zmq.md). Needs pyzmq and msgpack; numpy where pictures are arrays.

    from gloam_zmq import Client
    with Client() as sim:                      # gloam run SCENE --zmq, by the same user on this machine
        sim.pause()
        state = sim.step(10)                   # lockstep: answers when the steps are done
        for message in sim.stream(["state/100", "/front/image_raw"]):
            print(message.topic, message.time)

Units are SI, angles radians, quaternions w x y z, Z up; times are simulation time unless they say otherwise.
"""
from gloam_zmq.client import Client
from gloam_zmq.errors import GloamError
from gloam_zmq.stream import Message, Stream

__all__ = ["Client", "GloamError", "Message", "Stream"]
