// Icons of 16 by 16.
const kPaths: Record<string, string> = {
  reset: "M3 3h2v10H3zM13 2.5v11l-7-5.5z",
  back: "M8.5 2.5v11L2 8zM10.5 3h2v10h-2z",
  play: "M4 2.5v11l9-5.5z",
  pause: "M4 3h3v10H4zM9 3h3v10H9z",
  step: "M3 2.5v11l7-5.5zM11 3h2v10h-2z",
  minus: "M3 7h10v2H3z",
  plus: "M3 7h4V3h2v4h4v2H9v4H7V9H3z",
  record: "M8 3a5 5 0 1 1 0 10A5 5 0 0 1 8 3z",
  camera: "M2 4h3l1-1.5h4L11 4h3v9H2zM8 6a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5z",
  theme: "M8 2a6 6 0 1 0 0 12A6 6 0 0 0 8 2zm0 1.6v8.8A4.4 4.4 0 0 1 8 3.6z",
  help: "M8 1.8A6.2 6.2 0 1 0 8 14.2 6.2 6.2 0 0 0 8 1.8zM7.2 10.6h1.6v1.6H7.2zM5.6 6.3C5.6 4.9 6.6 4 8 4s2.4.9 2.4 2.1c0 1.6-1.7 1.7-1.7 3.3H7.3c0-2 1.6-2.3 1.6-3.2 0-.5-.4-.9-.9-.9-.6 0-1 .4-1 1z",
};

export function Icon({ name }: { name: string }) {
  return <svg viewBox="0 0 16 16" width="14" height="14" aria-hidden="true" fill-rule="evenodd"><path d={kPaths[name]} /></svg>;
}
