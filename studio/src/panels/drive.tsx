import { drive_goal, drive_speed, drive_turn, driving, gamepad_name } from "../drive";
import { blocked, model } from "../state";
import { Empty } from "../widgets/section";
import { Slider } from "../widgets/slider";

export function Drive() {
  const robots = (model.value?.robots ?? []).map((robot, index) => ({ ...robot, index })).filter(({ drives }) => drives);
  if (!robots.length) return <Empty text="No robot of this scene has a controller that accepts velocities." />;
  const { vx, vy, yaw_rate, vz } = drive_goal.value;
  return (
    <>
      <label class="row">
        <span class="name">Robot</span>
        <select id="drive-robot" value={driving.value ?? ""} disabled={!!blocked.value} title={blocked.value}
          onChange={(event) => { driving.value = event.currentTarget.value === "" ? null : Number(event.currentTarget.value); }}>
          <option value="">none</option>
          {robots.map(({ name, index }) => <option key={index} value={index}>{name}</option>)}
        </select>
      </label>
      <Slider label="Speed" unit="m/s" value={drive_speed} low={0} high={3} set={(value) => { drive_speed.value = value; }} />
      <Slider label="Turn" unit="rad/s" value={drive_turn} low={0} high={4} set={(value) => { drive_turn.value = value; }} />
      <p class="hint">W and S: forwards, backwards. A and D: turn. Q and E: sideways. R and F: up, down. Or a gamepad{gamepad_name.value && `: ${gamepad_name.value}`}.</p>
      {driving.value !== null && (
        <p class="numbers" id="drive-goal">{vx.toFixed(2)} {vy.toFixed(2)} {vz.toFixed(2)} m/s, {yaw_rate.toFixed(2)} rad/s</p>
      )}
    </>
  );
}
