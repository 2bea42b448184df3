// The script of a page written by `glint publish`. The page itself contains everything that it needs.
import { useEngine } from "./glint-figure.js"
import { loadFrom } from "./inside.js"
import { jobOf } from "./source.js"

useEngine(loadFrom(document.getElementById("glint-wasm").textContent, document.getElementById("glint-font")?.textContent))
document.querySelector("glint-figure").given = jobOf(document)
