// The engine of a page that has it inside.
import { loadWithFont } from "./renderer.js"
import { bytesOf } from "./source.js"
import workerText from "./worker.txt"

const unzipped = base64 => new Response(new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer()

// Loads the engine from the base64 of glint.wasm.gz and of glint.ttf.gz, which may be missing.
export async function loadFrom(...texts) {
  const [wasm, font = null] = await Promise.all(texts.filter(Boolean).map(unzipped))
  const worker = new Blob(["(async () => {", workerText, "\n})()"], { type: "text/javascript" })
  return loadWithFont({ wasm, font, worker: URL.createObjectURL(worker) })
}
