// The engine of a page that has it inside.
import { load } from "./glint.mjs"
import { bytesOf } from "./source.js"
import workerText from "./worker.txt"

// Loads the engine from the base64 of glint.wasm.gz.
export async function loadFrom(base64) {
  const squeezed = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream("gzip"))
  const wasm = await new Response(squeezed).arrayBuffer()
  const worker = new Blob(["(async () => {", workerText, "\n})()"], { type: "text/javascript" })
  return load({ wasm, worker: URL.createObjectURL(worker) })
}
