// Renders the first picture of a script without its overlays, which inline.mjs puts over it; with at least four samples.
//   node picture.mjs WEB SCRIPT OUT [WIDTH HEIGHT]
// WEB contains the module and its font.
import { readFileSync, writeFileSync } from "node:fs"
import { basename, resolve } from "node:path"
import { pathToFileURL } from "node:url"

const [web, script, out, width, height] = process.argv.slice(2)
const { load } = await import(pathToFileURL(resolve(web, "glint.mjs")))
const job = await (await load({ font: true })).open(readFileSync(script, "utf8"), { name: basename(script), seconds: 300 })
const size = width ? { width, height } : {}, layers = { width: Number(width ?? job.width), height: Number(height ?? job.height) }
writeFileSync(out, (await job.render({ ...size, samples: Math.max(4, job.samples), layers })).png())
job.close()
