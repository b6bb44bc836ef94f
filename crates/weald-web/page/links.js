// Links that hold a landscape: the recipe and the script of what was done, packed into the part of the address behind `#`.

const KEY = "land=";
// Longer addresses are cut by programs through which people send them.
export const LONGEST = 16000;

// What comes out of a stream. Both ends fail when the bytes are broken: whoever waits for one alone leaves an error to the page.
async function through(bytes, stream) {
  const parts = [];
  const read = async () => {
    for (const reader = stream.readable.getReader(); ; ) {
      const { done, value } = await reader.read();
      if (done) return;
      parts.push(value);
    }
  };
  await Promise.all([read(), new Blob([bytes]).stream().pipeTo(stream.writable)]);
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

export async function linkOf(recipe, script) {
  const text = new TextEncoder().encode(JSON.stringify({ recipe, script }));
  const packed = await through(text, new CompressionStream("deflate-raw"));
  const letters = Array.from(packed, (byte) => String.fromCharCode(byte)).join("");
  const safe = btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  const address = new URL(location.href);
  address.hash = KEY + safe;
  return address.href;
}

// The recipe and the script of this page's address, or null where it holds none.
export async function landOf(hash) {
  if (!hash.startsWith("#" + KEY)) return null;
  const letters = atob(hash.slice(KEY.length + 1).replaceAll("-", "+").replaceAll("_", "/"));
  const packed = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
  const text = await through(packed, new DecompressionStream("deflate-raw"));
  const { recipe, script } = JSON.parse(new TextDecoder().decode(text));
  if (typeof recipe !== "string" || typeof script !== "string") throw new Error("it holds no recipe");
  return { recipe, script };
}
