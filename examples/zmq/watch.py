#!/usr/bin/env python3
"""States and pictures of a run that goes on; pictures come through shared memory on one machine.

    gloam run examples/zmq/cartpole.toml
    PYTHONPATH=python python3 examples/zmq/watch.py
"""
from gloam_zmq import Client

with Client() as sim:
    cameras = [topic["name"] for topic in sim.topics() if topic["name"].endswith("/image_raw")]
    sim.resume()
    with sim.stream(["state/50", *cameras[:1]], timeout=30) as stream:
        pictures = 0
        for message in stream:
            if message.topic == "state/50":
                print(f"{message.time:8.3f} s  step {message.step}")
            else:
                picture = message.image()  # a view of shared memory
                mean = picture.mean()
                if message.is_valid:  # not overwritten while it was read
                    pictures += 1
                    print(f"{message.time:8.3f} s  {message.topic} {picture.shape}, mean {mean:.1f}")
            if pictures == 3 or (not cameras and message.time > 0.5):
                break
    sim.pause()
