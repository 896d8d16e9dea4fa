/** A labelled check box. */
export function Check({ id, label, tip, on, disabled, set }: { id?: string; label: string; tip?: string; on: boolean; disabled?: string; set: (on: boolean) => void }) {
  return (
    <label class="check" title={disabled || tip}>
      <input id={id} type="checkbox" checked={on} disabled={!!disabled} onChange={(event) => set(event.currentTarget.checked)} />
      <span>{label}</span>
    </label>
  );
}
