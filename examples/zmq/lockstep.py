#!/usr/bin/env python3
"""Keeps a pole upright from another process, in lockstep: it sees each state before the next step is taken.

    gloam run examples/zmq/cartpole.toml --paused
    PYTHONPATH=python python3 examples/zmq/lockstep.py
"""
from gloam_zmq import Client

# Force [N] per m, m/s of the cart, rad, rad/s of the pole: linear-quadratic, weights 1, 1, 10, 1 and 0.1.
GAINS = (3.2, 5.8, 45.9, 9.2)

with Client() as sim:
    sim.pause()
    sim.claim("cartpole")
    sim.joint_states(positions={"cartpole/hinge": [0.2]})
    state = sim.step()
    for _ in range(1000):
        x, angle = state["qpos"]
        v, rate = state["qvel"]
        force = sum(gain * value for gain, value in zip(GAINS, (x, v, angle, rate)))
        sim.controls([max(-20.0, min(20.0, force))], robot="cartpole")
        state = sim.step(5)
    print(f"step {state['step']}, {state['time']:.3f} s, cart at {state['qpos'][0]:.4f} m, pole at {state['qpos'][1]:.4f} rad, "
          f"hash {state['hash']:016x}")
