// Messages of docs/view_protocol.md, version 2, and the parsers of the two binary ones.

export interface Hello {
  type: "hello"; version: number; client: number; title: string; cameras: string[]; step_rate: number; log_end: number;
}
export interface State {
  type: "state"; step: number; time: number; hash: string; realtime_factor: number; paused: boolean; speed: number; camera: string;
  dropped: number; warnings: number; error: string; clients: number; controller: number; history_start: number; run: number; serial: number;
}
export interface Model {
  type: "model"; bodies: string[]; joints: string[]; geoms: string[]; sites: string[]; actuators: string[]; sensors: string[];
  tendons: string[]; equalities: string[]; keyframes: string[]; lights: string[]; meshes: string[];
  robots: { name: string; drives: boolean }[]; serial: number;
}
export interface Picked { type: "picked"; found: boolean; body?: string; id?: number; point?: Vector; dragging?: boolean }
export interface Pulled { type: "pulled"; point: Vector }
export interface Copied { type: "copied"; text: string }
export interface Notice { type: "notice"; text: string }
export type ServerMessage = Hello | State | Model | Picked | Pulled | Copied | Notice;

export interface ClientMessage { type: string; [key: string]: unknown }

export type Vector = [number, number, number];

/** Numbers of MuJoCo's arrays at one instant. */
export interface FieldReply { id: number; step: number; time: number; serial: number; values: Map<string, Float32Array> }

/** The header of an image: its camera in the world, looking along −Z with +Y up, and its lens. */
export interface ImageHeader {
  sequence: bigint; time: number; width: number; height: number; orthographic: boolean; h264: boolean; key: boolean;
  fx: number; fy: number; cx: number; cy: number; position: Vector; quaternion: [number, number, number, number];
  lens: number; coefficients: number[];
}

export const kPinhole = 0;
const kImageMagic = 0x474c5631;  // GLV1
const kFieldMagic = 0x474c4631;  // GLF1
const kImageHeaderSize = 152;

export type Binary = { kind: "image"; header: ImageHeader; coded: Uint8Array<ArrayBuffer> } | { kind: "fields"; reply: FieldReply };

/** Parses a binary message; null for one of another version. */
export function parse_binary(bytes: ArrayBuffer): Binary | null {
  const view = new DataView(bytes);
  if (bytes.byteLength < 8) return null;
  const magic = view.getUint32(0);
  if (magic === kFieldMagic) return { kind: "fields", reply: parse_fields(view) };
  if (magic === kImageMagic && bytes.byteLength >= kImageHeaderSize)
    return { kind: "image", header: parse_image_header(view), coded: new Uint8Array(bytes, view.getUint32(4, true)) };
  return null;
}

function parse_fields(view: DataView<ArrayBuffer>): FieldReply {
  const length = view.getUint32(4, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(view.buffer, 8, length)));
  const values = new Map<string, Float32Array>();
  let offset = 8 + length;
  for (const { name, count } of head.fields) {
    values.set(name, new Float32Array(view.buffer, offset, count));
    offset += 4 * count;
  }
  return { id: head.id, step: head.step, time: head.time, serial: head.serial, values };
}

function parse_image_header(view: DataView): ImageHeader {
  const f32 = (at: number) => view.getFloat32(at, true), f64 = (at: number) => view.getFloat64(at, true);
  const flags = view.getUint32(40, true);
  return {
    sequence: view.getBigUint64(8, true), time: f64(24), width: view.getUint16(32, true), height: view.getUint16(34, true),
    orthographic: (flags & 1) !== 0, h264: (flags & 2) !== 0, key: (flags & 4) !== 0,
    fx: f32(44), fy: f32(48), cx: f32(52), cy: f32(56),
    position: [f64(60), f64(68), f64(76)], quaternion: [f64(84), f64(92), f64(100), f64(108)],
    lens: view.getUint32(116, true), coefficients: [0, 1, 2, 3, 4, 5, 6, 7].map((i) => f32(120 + 4 * i)),
  };
}
