"""Time of one solution of Mink on a robot: the problem of bench/ik_rate.cc. Prints JSON.

    mink_rate.py MODEL.xml SITE...
"""
import json
import statistics
import sys
import time

import mink
import mujoco
import numpy as np

SOLUTIONS = 400
model_file, *sites = sys.argv[1:]
model = mujoco.MjModel.from_xml_path(model_file)
rng = np.random.default_rng(7)
configuration = mink.Configuration(model)
frames = [mink.FrameTask(site, "site", 1.0, 1.0) for site in sites]
posture = mink.PostureTask(model, 0.1)
posture.set_target(model.qpos0)
joints = [j for j in range(model.njnt) if model.jnt_type[j] != mujoco.mjtJoint.mjJNT_FREE]
limits = [mink.ConfigurationLimit(model), mink.VelocityLimit(model, {model.joint(j).name: 3.0 for j in joints})]
times = {"daqp": [], "quadprog": []}
for _ in range(SOLUTIONS):
    for frame in frames:
        q = np.array([rng.uniform(0.1, 1), *rng.uniform(-1, 1, 3)])
        frame.set_target(mink.SE3(np.concatenate([q / np.linalg.norm(q), rng.uniform(-0.5, 0.5, 2), rng.uniform(0, 1, 1)])))
    qpos = model.qpos0.copy()
    for j in range(model.njnt):
        if model.jnt_limited[j]:
            qpos[model.jnt_qposadr[j]] = rng.uniform(*model.jnt_range[j])
    for solver, spent in times.items():
        begin = time.perf_counter()
        configuration.update(qpos)
        mink.solve_ik(configuration, [*frames, posture], 0.01, solver, 1e-6, limits=limits)
        spent.append((time.perf_counter() - begin) * 1e6)
print(json.dumps({"nv": model.nv, "solve_us": min(statistics.median(spent) for spent in times.values())}))
