// Foxglove's own client package against the bridge: node --experimental-websocket FILE MODULES ADDRESS
// prints what it has seen as one JSON object.
import { createRequire } from "node:module";
import { join } from "node:path";

const [modules, address] = process.argv.slice(2);
const require = createRequire(join(modules, "index.js"));
const { FoxgloveClient } = require("@foxglove/ws-protocol");

const seen = { errors: [], messages: {}, capabilities: [], heard: [] };
const client = new FoxgloveClient({ ws: new WebSocket(address, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
const channels = new Map(), services = new Map(), topics = new Map();
let now = -1n;

client.on("error", (error) => seen.errors.push(String(error)));
client.on("status", (status) => seen.errors.push(status.message));
client.on("serverInfo", (info) => { seen.capabilities = info.capabilities; });
client.on("advertise", (list) => list.forEach((channel) => channels.set(channel.topic, channel)));
client.on("advertiseServices", (list) => list.forEach((service) => services.set(service.name, service)));
client.on("message", ({ subscriptionId }) => {
  const topic = topics.get(subscriptionId);
  seen.messages[topic] = (seen.messages[topic] ?? 0) + 1;
});
client.on("time", ({ timestamp }) => { now = timestamp; });
client.on("connectionGraphUpdate", (graph) => { seen.heard = graph.subscribedTopics.map((topic) => topic.name); });

const sleep = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
async function until(what, holds) {
  for (let i = 0; i < 2400; ++i) {
    if (holds()) return;
    await sleep(25);
  }
  throw new Error(`no ${what} in a minute: ${JSON.stringify(seen)}`);
}
const answer = (event, act) => new Promise((done) => { client.on(event, done); act(); });

await until("channels and services", () => channels.size > 0 && services.size > 0);
for (const topic of ["/tf", "/chase/image_raw/compressed"]) topics.set(client.subscribe(channels.get(topic).id), topic);
client.subscribeConnectionGraph();
await until("pictures", () => seen.messages["/chase/image_raw/compressed"] > 0 && seen.messages["/tf"] > 5);
topics.forEach((_, id) => client.unsubscribe(id));

const request = { serviceId: services.get("/pause").id, callId: 1, encoding: "json", data: new DataView(new TextEncoder().encode("{}").buffer) };
const response = await answer("serviceCallResponse", () => client.sendServiceCallRequest(request));
seen.pause = JSON.parse(new TextDecoder().decode(response.data));
const values = await answer("parameterValues", () => client.setParameters([{ name: "speed", value: 0.25 }], "set"));
seen.speed = values.parameters[0].value;
const asset = await answer("fetchAssetResponse", () => client.fetchAsset("file:///etc/passwd", 7));
seen.asset_status = asset.status;

const reset = client.advertise({ topic: "/reset", encoding: "cdr", schemaName: "std_msgs/msg/Empty" });
client.sendMessage(reset, new Uint8Array([0, 1, 0, 0, 0]));
await until("reset", () => now >= 0n && now < 200000000n);
seen.time_after_reset = Number(now) * 1e-9;
console.log(JSON.stringify(seen));
process.exit(0);
