// The engine of a page that has it inside.
import { loadWithFont } from "./renderer.js"
import { bytesOf } from "./source.js"
import workerText from "./worker.txt"

// Returns the response whose body is what a base64 text has compressed.
export const unzipped = (base64, type) =>
  new Response(new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream("gzip")), { headers: { "content-type": type } })

// Loads the engine from the base64 of glint.wasm.gz and the bytes of a font, which may be missing. The module is compiled
// while it is decompressed.
export async function loadFrom(wasm, font) {
  const worker = new Blob(["(async () => {", workerText, "\n})()"], { type: "text/javascript" })
  return loadWithFont({ wasm: unzipped(wasm, "application/wasm"), font: await font ?? null, worker: URL.createObjectURL(worker) })
}
