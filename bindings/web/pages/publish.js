// The script of a page written by `glint publish`. The page itself contains everything that it needs.
import { load } from "./glint.mjs"
import { useEngine } from "./glint-figure.js"
import workerText from "./worker.txt"

const textOf = id => document.getElementById(id).textContent
const bytesOf = base64 => Uint8Array.from(atob(base64), letter => letter.charCodeAt(0))

async function loadFromPage() {
  const squeezed = new Blob([bytesOf(textOf("glint-wasm"))]).stream().pipeThrough(new DecompressionStream("gzip"))
  const wasm = await new Response(squeezed).arrayBuffer()
  const worker = new Blob(["(async () => {", workerText, "\n})()"], { type: "text/javascript" })
  return load({ wasm, worker: URL.createObjectURL(worker) })
}

const { name, text, files, same, values } = JSON.parse(textOf("glint-job"))
const given = Object.fromEntries(Object.entries(files).map(([file, base64]) => [file, bytesOf(base64)]))
for (const [file, short] of Object.entries(same)) given[file] = given[short]
useEngine(loadFromPage())
document.querySelector("glint-figure").given = { name, text, files: given, values }
