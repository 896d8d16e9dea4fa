import type { Panel } from "../widgets/side_panel";
import { Contacts } from "./contacts";
import { Control } from "./control";
import { Drive } from "./drive";
import { Equalities } from "./equalities";
import { Groups } from "./groups";
import { Joints } from "./joints";
import { Keyframes } from "./keyframes";
import { Physics } from "./physics";
import { Plots } from "./plots";
import { Profiler } from "./profiler";
import { Sensors } from "./sensors";
import { Visualization } from "./visualization";
import { Watch } from "./watch";

// A panel is one file and one line here.

export const kLeftPanels: readonly Panel[] = [
  { title: "Physics", tip: "Options and sizes of the physics", body: Physics },
  { title: "Visualization", tip: "Quantities drawn over the image", body: Visualization },
  { title: "Group enable", tip: "Groups of geoms and sites that overlays show", body: Groups },
  { title: "Drive", tip: "Drive a robot with the keyboard or a gamepad", body: Drive },
  { title: "Keyframes", tip: "Load, save, copy and paste states", body: Keyframes },
];

export const kRightPanels: readonly Panel[] = [
  { title: "Joints", tip: "Positions of joints", body: Joints },
  { title: "Control", tip: "Controls of actuators", body: Control },
  { title: "Equality", tip: "Switches of equality constraints", body: Equalities },
  { title: "Sensors", tip: "Readings of the model's sensors", body: Sensors },
  { title: "Contacts", tip: "Contacts and their forces", body: Contacts },
  { title: "Watch", tip: "Any number of MuJoCo's model and state", body: Watch },
  { title: "Plots", tip: "Energy, sensors and watched numbers over time", body: Plots },
  { title: "Profiler", tip: "Speed, contacts and constraints over time", body: Profiler },
];
