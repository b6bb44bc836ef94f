// How the program waits in its worker for what the browser brings later: its stack is put aside until it is woken, and
// meanwhile the browser goes on (WebAssembly JavaScript Promise Integration).

export const canWait = "Suspending" in WebAssembly && "promising" in WebAssembly;

// Wakes the program that is suspended, where one is.
let wakeIt = null;
let isAwake = false;

// What the program calls.
export const waiting = {
  suspend(milliseconds) {
    if (isAwake) {
      isAwake = false;
      return 0;
    }
    return new Promise((resolve) => {
      const wake = () => {
        clearTimeout(timer);
        wakeIt = null;
        resolve(0);
      };
      const timer = setTimeout(wake, milliseconds);
      wakeIt = wake;
    });
  },
  wake() {
    if (wakeIt) wakeIt();
    else isAwake = true;
  },
};

// Makes of the one function among the imports that suspends the program one that can.
function suspending(imports) {
  const found = [];
  for (const functions of Object.values(imports)) {
    for (const [name, does] of Object.entries(functions)) {
      if (!name.startsWith("__wbg_suspend_")) continue;
      functions[name] = new WebAssembly.Suspending(does);
      found.push(name);
    }
  }
  if (found.length !== 1) throw new Error(`the program should import one function that suspends it, and has ${found.length}`);
  return imports;
}

// Begins the program by what wasm-bindgen has made, which lets nobody else at its imports.
export async function begin(init, module) {
  const instantiate = WebAssembly.instantiate;
  if (canWait) {
    WebAssembly.instantiate = (module, imports) => instantiate.call(WebAssembly, module, suspending(imports));
  }
  try {
    return await init({ module_or_path: module });
  } finally {
    WebAssembly.instantiate = instantiate;
  }
}
