import { key_text } from "../actions";
import { kOverlays, toggle_overlay } from "../overlays";
import { draw_here, overlays_on, show_info } from "../settings";
import { Check } from "../widgets/check";

export function Visualization() {
  return (
    <>
      <Check id="draw-here" label="Draw here" tip="The browser draws the collision and visual geoms itself, with its own camera: for slow links (W)"
        on={draw_here.value} set={(on) => { draw_here.value = on; }} />
      <Check id="show-info" label="Information over the image" tip="Time, camera and selection in the image (F2)" on={show_info.value}
        set={(on) => { show_info.value = on; }} />
      <hr />
      {kOverlays.map(({ id, label, key, tip }) => (
        <Check key={id} id={`overlay-${id}`} label={label} tip={key ? `${tip} (${key_text(key)})` : tip} on={overlays_on.value.includes(id)}
          set={() => toggle_overlay(id)} />
      ))}
    </>
  );
}
