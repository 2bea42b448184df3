// Live figures of a page that is opened from a disk, where a browser loads neither modules nor data: the engine is in
// this script.
import base64 from "./glint.wasm.gz"
import { loadFrom } from "./inside.js"
import { useEngine } from "./glint-figure.js"

useEngine(loadFrom(base64))
