// The worker: runs recipes and simulations, in turns between which messages of the page come in.
import init, { Server } from "./weald_web.js";

let server = null;
let timer = null;
const early = [];
// A message to oneself comes sooner than the four milliseconds of a timer.
const again = new MessageChannel();
again.port1.onmessage = turn;

function schedule(rest) {
  clearTimeout(timer);
  timer = null;
  if (rest === 0) again.port2.postMessage(null);
  else if (rest > 0) timer = setTimeout(turn, rest);
}

function turn() {
  timer = null;
  if (server.rest() >= 0) schedule(server.turn());
}

function take({ text, arrays }) {
  server.take(text, arrays);
  schedule(server.rest());
}

onmessage = async ({ data }) => {
  if (data.module) {
    await init({ module_or_path: data.module });
    server = new Server();
    early.splice(0).forEach(take);
  } else if (server) take(data);
  else early.push(data);
};
