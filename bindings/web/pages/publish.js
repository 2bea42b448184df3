// The script of a page written by `glint publish`. The page itself contains everything that it needs.
import { setText } from "./formula.js"
import { useEngine } from "./glint-figure.js"
import { loadFrom } from "./inside.js"
import { bytesOf, jobOf } from "./source.js"

for (const heading of document.querySelectorAll("h1")) setText(heading, heading.textContent)
const font = /base64,([^"]*)/.exec(document.getElementById("glint-font").textContent)
useEngine(loadFrom(document.getElementById("glint-wasm").textContent, font && bytesOf(font[1])))
document.querySelector("glint-figure").given = jobOf(document)
