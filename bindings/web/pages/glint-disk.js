// Live figures of a page that is opened from a disk, where a browser loads neither modules nor data: the engine is in
// this script.
import wasm from "./glint.wasm.gz"
import font from "./glint.ttf.gz"
import { loadFrom, unzipped } from "./inside.js"
import { useEngine } from "./glint-figure.js"

useEngine(loadFrom(wasm, unzipped(font, "font/ttf").arrayBuffer()))
