import { signal } from "@preact/signals";
import { parse_binary, type ClientMessage, type FieldReply, type ImageHeader, type ServerMessage } from "./protocol";
import { blocked, hello, in_control, link_problem, link_state, live, model, show_notice, state } from "./state";

// The WebSocket. It reconnects with a growing delay and passes each message to the handlers of its type.

type Handlers = { [K in ServerMessage["type"]]?: (message: Extract<ServerMessage, { type: K }>) => void };
const handlers: Handlers[] = [];
let on_image: (header: ImageHeader, coded: Uint8Array<ArrayBuffer>) => void = () => {};
let on_fields: (reply: FieldReply) => void = () => {};

let socket: WebSocket | null = null;
let retries = 0;
let ended = false;

/** Counts connections, so that requests are repeated on a new one. */
export const connection = signal(0);

export function handle(added: Handlers) { handlers.push(added); }
export function handle_images(handler: typeof on_image) { on_image = handler; }
export function handle_fields(handler: typeof on_fields) { on_fields = handler; }

export function connect() {
  link_state.value = "connecting";
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  socket = new WebSocket(`${scheme}://${location.host}/ws`);
  socket.binaryType = "arraybuffer";
  let greeted = false;
  socket.onmessage = (event) => {
    greeted = true;
    if (typeof event.data === "string") receive(JSON.parse(event.data));
    else receive_binary(event.data);
  };
  socket.onclose = (event) => lose(event.code, greeted);
}

function receive(message: ServerMessage) {
  if (message.type === "hello") {
    hello.value = message;
    retries = 0;
    link_problem.value = "";
    link_state.value = "live";
    connection.value++;
    send({ type: "describe" });
  } else if (message.type === "state") {
    if (model.value && message.serial !== model.value.serial && message.serial !== state.value?.serial) send({ type: "describe" });
    state.value = message;
  } else if (message.type === "model") {
    model.value = message;
  } else if (message.type === "notice") {
    show_notice(message.text);
  }
  for (const each of handlers) (each[message.type] as ((m: ServerMessage) => void) | undefined)?.(message);
}

function receive_binary(bytes: ArrayBuffer) {
  const message = parse_binary(bytes);
  if (message?.kind === "image") on_image(message.header, message.coded);
  else if (message?.kind === "fields") on_fields(message.reply);
}

async function lose(code: number, greeted: boolean) {
  socket = null;
  state.value = null;
  ended ||= code === 1001;
  link_state.value = ended ? "ended" : "lost";
  link_problem.value = ended ? "The simulation has ended. Start it again and open the address that it prints."
    : code === 1013 ? "This page could not keep up and was disconnected. Trying again…"
    : "The connection to the simulation is lost. Trying again…";
  // Another simulation may use this address now. It has a new token, so that retries are useless.
  if (!ended && !greeted && await is_unauthorized()) {
    ended = true;
    link_state.value = "ended";
    link_problem.value = "Another simulation runs at this address now. Open the address that it printed.";
  }
  if (!ended) window.setTimeout(connect, Math.min(5000, 400 * 2 ** retries++));
}

async function is_unauthorized() {
  try {
    return (await fetch("/")).status === 401;
  } catch {
    return false;
  }
}

export function send(message: ClientMessage) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

/** Sends a message that only the client in control may send, or shows the reason why it may not. Returns whether it was sent. */
export function command(message: ClientMessage): boolean {
  if (in_control.value) send(message);
  else if (live.value) show_notice(blocked.value);
  return in_control.value;
}

/** Sends a message with a known result, so that the next key press builds on it before the server answers. */
export function command_with(message: ClientMessage, result: Partial<NonNullable<typeof state.value>>) {
  if (command(message)) state.value = { ...state.value!, ...result };
}
