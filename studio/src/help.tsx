import { useEffect, useRef } from "preact/hooks";
import { kActions, kGestures, key_text } from "./actions";
import { help_open } from "./state";

/** All keys and gestures, from the list of actions. */
export function HelpDialog() {
  const dialog = useRef<HTMLDialogElement>(null);
  const open = help_open.value;
  useEffect(() => {
    if (open && !dialog.current!.open) dialog.current!.showModal();
    if (!open && dialog.current!.open) dialog.current!.close();
  }, [open]);
  const groups = [...new Set(kActions.map((each) => each.group))];
  return (
    <dialog id="help" ref={dialog} aria-labelledby="help-title" onClose={() => { help_open.value = false; }}>
      <h2 id="help-title">Keys and mouse</h2>
      <div class="columns">
        {groups.map((group) => <KeyTable key={group} title={group} rows={kActions.filter((each) => each.group === group && each.keys.length)
          .map((each): [string, string] => [each.keys.map(key_text).join(", "), each.label])} />)}
        <KeyTable title="Mouse" rows={kGestures} plain />
      </div>
      <button class="primary" autofocus onClick={() => { help_open.value = false; }}>Close</button>
    </dialog>
  );
}

function KeyTable({ title, rows, plain = false }: { title: string; rows: readonly [string, string][]; plain?: boolean }) {
  if (!rows.length) return null;
  return (
    <table class={plain ? "mouse" : ""}>
      <caption>{title}</caption>
      <tbody>{rows.map(([keys, label]) => <tr key={label}><th scope="row">{plain ? keys : <kbd>{keys}</kbd>}</th><td>{label}</td></tr>)}</tbody>
    </table>
  );
}
