import { use_watch } from "../fields";
import { command } from "../link";
import { blocked, model, name_of } from "../state";
import { Check } from "../widgets/check";
import { Empty } from "../widgets/section";

export function Equalities() {
  const [active] = use_watch("eq_active");
  const names = model.value?.equalities ?? [];
  if (!names.length) return <Empty text="This model has no equality constraints." />;
  return <>{names.map((_, i) => (
    <Check key={i} id={`equality-${i}`} label={name_of(names, i, "equality")} on={active.value[i] > 0} disabled={blocked.value}
      set={(on) => command({ type: "set_equality", equality: i, active: on })} />
  ))}</>;
}
