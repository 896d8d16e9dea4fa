"""Models for the tests of gloam.ik: files of the repository, and two that are written here."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

LINK = '<geom name="{name}" type="capsule" size="{size}" fromto="0 0 0 {to}"/>'


def arm(folder: Path, joints: int = 7) -> Path:
    """A fixed arm of hinges about z and y in turn, with a site "tool" at its end."""
    body, close = "", ""
    for i in range(joints):
        axis, limit = ("0 0 1", 2.9) if i % 2 == 0 else ("0 1 0", 2.1)
        body += (
            f'<body name="link{i}" pos="0 0 {0.15 if i else 0.1}"><joint name="j{i}" axis="{axis}" '
            f'range="-{limit} {limit}"/><geom name="link{i}" type="capsule" size=".04" fromto="0 0 0 0 0 .1"/>'
        )
        close += "</body>"
    text = f"""<mujoco><compiler autolimits="true" angle="radian"/><worldbody>
      <geom name="floor" type="plane" size="2 2 .1" pos="0 0 -.3"/>
      <geom name="post" type="box" size=".05 .05 .4" pos=".35 .1 .3"/>
      <body name="base">{body}<site name="tool" pos="0 0 .12"/>{close}</body></worldbody></mujoco>"""
    path = folder / "arm7.xml"
    path.write_text(text)
    return path


def _leg(side: str, y: float) -> str:
    return f"""<body name="{side}_hip" pos="0 {y} -.1"><joint name="{side}_hip_pitch" axis="0 1 0" range="-2 2"/>
      <joint name="{side}_hip_roll" axis="1 0 0" range="-1 1"/><joint name="{side}_hip_yaw" axis="0 0 1" range="-1.5 1.5"/>
      {LINK.format(name=side + "_thigh", size=0.05, to="0 0 -.3")}
      <body name="{side}_shin" pos="0 0 -.32"><joint name="{side}_knee" axis="0 1 0" range="-.1 2.6"/>
        {LINK.format(name=side + "_shin", size=0.04, to="0 0 -.28")}
        <body name="{side}_foot" pos="0 0 -.3"><joint name="{side}_ankle_pitch" axis="0 1 0" range="-.9 .9"/>
          <joint name="{side}_ankle_roll" axis="1 0 0" range="-.4 .4"/>
          <geom name="{side}_foot" type="box" size=".09 .04 .02" pos=".03 0 -.02"/>
          <site name="{side}_sole" pos=".03 0 -.04"/></body></body></body>"""


def _arm(side: str, y: float) -> str:
    return f"""<body name="{side}_shoulder" pos="0 {y} .3"><joint name="{side}_shoulder_pitch" axis="0 1 0" range="-3 3"/>
      <joint name="{side}_shoulder_roll" axis="1 0 0" range="-2 2"/><joint name="{side}_shoulder_yaw" axis="0 0 1" range="-2 2"/>
      {LINK.format(name=side + "_upper_arm", size=0.04, to="0 0 -.22")}
      <body name="{side}_forearm" pos="0 0 -.24"><joint name="{side}_elbow" axis="0 1 0" range="-2.2 .1"/>
        {LINK.format(name=side + "_forearm", size=0.035, to="0 0 -.18")}
        <body name="{side}_wrist" pos="0 0 -.2"><joint name="{side}_wrist_roll" axis="0 0 1" range="-1.9 1.9"/>
          <joint name="{side}_wrist_pitch" axis="0 1 0" range="-1.6 1.6"/><joint name="{side}_wrist_yaw" axis="1 0 0" range="-1.6 1.6"/>
          <geom name="{side}_hand" type="sphere" size=".045" pos="0 0 -.05"/><site name="{side}_palm" pos="0 0 -.08"/>
        </body></body></body>"""


def humanoid(folder: Path) -> Path:
    """A humanoid of 29 joints on a free base, in the layout of Unitree's G1: legs of 6, arms of 7, a waist of 3."""
    text = f"""<mujoco><compiler autolimits="true" angle="radian"/><worldbody>
      <geom name="floor" type="plane" size="5 5 .1"/>
      <body name="pelvis" pos="0 0 .78"><freejoint name="floating"/><geom name="pelvis" type="box" size=".08 .1 .06"/>
        {_leg("left", 0.1)}{_leg("right", -0.1)}
        <body name="torso" pos="0 0 .08"><joint name="waist_yaw" axis="0 0 1" range="-2.6 2.6"/>
          <joint name="waist_roll" axis="1 0 0" range="-.5 .5"/><joint name="waist_pitch" axis="0 1 0" range="-.5 .5"/>
          <geom name="torso" type="box" size=".09 .12 .17" pos="0 0 .17"/><site name="head" pos="0 0 .45"/>
          {_arm("left", 0.2)}{_arm("right", -0.2)}
        </body></body></worldbody></mujoco>"""
    path = folder / "humanoid.xml"
    path.write_text(text)
    return path


def chain_of_balls(folder: Path) -> Path:
    """Two limited ball joints, a slide and a hinge."""
    text = """<mujoco><compiler autolimits="true" angle="radian"/><worldbody>
      <body name="a" pos="0 0 1"><joint name="shoulder" type="ball" range="0 1.2"/><geom name="a" type="capsule" size=".05" fromto="0 0 0 .4 0 0"/>
        <body name="b" pos=".4 0 0"><joint name="elbow" type="ball" range="0 .9"/><geom name="b" type="capsule" size=".04" fromto="0 0 0 .3 0 0"/>
          <body name="c" pos=".3 0 0"><joint name="reach" type="slide" axis="1 0 0" range="-.1 .2"/><geom name="c" size=".05"/>
            <body name="d" pos=".1 0 0"><joint name="wrist" axis="0 1 0" range="-1 1"/><geom name="d" size=".03"/><site name="tip" pos=".1 0 0"/>
      </body></body></body></body></worldbody></mujoco>"""
    path = folder / "balls.xml"
    path.write_text(text)
    return path


def quadruped(_: Path) -> Path:
    return ROOT / "assets" / "robots" / "quadruped" / "quadruped.xml"
