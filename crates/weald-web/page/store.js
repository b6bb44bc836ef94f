// What the browser keeps: files of the studio by their paths, in IndexedDB. Without it the studio works and says so.

const NAME = "weald";
const FILES = "files";

function open() {
  return new Promise((resolve, reject) => {
    const asked = indexedDB.open(NAME, 1);
    asked.onupgradeneeded = () => asked.result.createObjectStore(FILES);
    asked.onsuccess = () => resolve(asked.result);
    asked.onerror = () => reject(asked.error);
  });
}

export class Store {
  #database = null;
  #failed = null;
  // Writing that goes on.
  #writes = new Set();

  // Opens the store; `failed` is told once in a sentence where nothing can be kept.
  static async open(failed) {
    const store = new Store();
    store.#failed = failed;
    try {
      store.#database = await open();
    } catch (cause) {
      store.#lose(cause);
    }
    return store;
  }

  #lose(cause) {
    this.#database = null;
    this.#failed?.(`This browser keeps nothing here (${cause?.message ?? cause}): export or share before you leave.`);
    this.#failed = null;
  }

  // All files, as pairs of path and bytes.
  async all() {
    if (!this.#database) return [];
    const files = this.#database.transaction(FILES).objectStore(FILES);
    const whole = (asked) =>
      new Promise((resolve, reject) => {
        asked.onsuccess = () => resolve(asked.result);
        asked.onerror = () => reject(asked.error);
      });
    const [paths, bytes] = await Promise.all([whole(files.getAllKeys()), whole(files.getAll())]);
    return paths.map((path, place) => [path, bytes[place]]);
  }

  // Waits until all that was given to it so far is written.
  async written() {
    await Promise.all(this.#writes);
  }

  // Keeps a file, or forgets it where there are no bytes.
  keep(path, bytes) {
    if (!this.#database) return;
    try {
      const done = this.#database.transaction(FILES, "readwrite");
      if (bytes) done.objectStore(FILES).put(bytes, path);
      else done.objectStore(FILES).delete(path);
      done.onerror = done.onabort = () => this.#lose(done.error);
      const whole = new Promise((resolve) => ["complete", "error", "abort"].forEach((end) => done.addEventListener(end, resolve)));
      this.#writes.add(whole);
      whole.then(() => this.#writes.delete(whole));
    } catch (cause) {
      this.#lose(cause);
    }
  }
}
