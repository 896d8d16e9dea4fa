import "uplot/dist/uPlot.min.css";
import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import { run, state } from "../state";

export interface Line { label: string; read: () => number }

const kSpan = 10;  // seconds of simulation time that a plot shows
const kPeriod = 100;  // [ms]
const kColours = ["#e0b667", "#6fb3d9", "#8fc77f", "#d98b8b", "#b79be0", "#d9c96f", "#6fd9c0", "#d97fb8"];

/** Numbers over the last seconds of simulation time. */
export function Plot({ title, lines }: { title: string; lines: readonly Line[] }) {
  const place = useRef<HTMLDivElement>(null);
  const newest = useRef(lines);
  newest.current = lines;
  useEffect(() => draw(place.current!, title, newest), [title, lines.length]);
  return <figure class="plot"><figcaption>{title}</figcaption><div ref={place} /></figure>;
}

function style_of(name: string) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function draw(place: HTMLElement, title: string, lines: { current: readonly Line[] }): () => void {
  const data: (number | null)[][] = [[], ...lines.current.map(() => [])];
  const axis = { stroke: () => style_of("--quiet"), grid: { stroke: () => style_of("--edge"), width: 1 }, ticks: { show: false }, font: "11px system-ui" };
  const plot = new uPlot({
    width: place.clientWidth || 280, height: 130, cursor: { show: true, drag: { x: false, y: false } }, legend: { show: true, live: true },
    scales: { x: { time: false } },
    axes: [{ ...axis, size: 22 }, { ...axis, size: 46 }],
    series: [{ label: "time [s]" }, ...lines.current.map(({ label }, i) => ({ label, stroke: kColours[i % kColours.length], width: 1.5 }))],
  }, data as uPlot.AlignedData, place);
  plot.root.setAttribute("aria-label", title);
  let last_time = -1, last_run = run.peek();
  const timer = window.setInterval(() => {
    const time = state.peek()?.time;
    if (time === undefined || time === last_time) return;
    if (time < last_time || run.peek() !== last_run) data.forEach((column) => { column.length = 0; });
    last_time = time;
    last_run = run.peek();
    data[0].push(time);
    lines.current.forEach(({ read }, i) => { const value = read(); data[i + 1]?.push(Number.isFinite(value) ? value : null); });
    while (data[0].length && data[0][0]! < time - kSpan) data.forEach((column) => column.shift());
    plot.setData(data as uPlot.AlignedData);
  }, kPeriod);
  const observer = new ResizeObserver(() => plot.setSize({ width: place.clientWidth, height: 130 }));
  observer.observe(place);
  return () => {
    clearInterval(timer);
    observer.disconnect();
    plot.destroy();
  };
}
