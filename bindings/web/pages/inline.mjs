// Writes a page with the script of each figure inside its element, with the parameters of the script, with the overlays of
// its still picture, and with a link to the playground, so that the page works from a disk and has its controls before the
// engine has started.
//   node inline.mjs PAGE SCRIPTS WEB
// PAGE is a page with <glint-figure src="...">, SCRIPTS the folder of scripts. WEB contains the module.
import { readFileSync } from "node:fs"
import { basename, join, resolve } from "node:path"
import { pathToFileURL } from "node:url"

const [page, scripts, web] = process.argv.slice(2)
const glint = await (await import(pathToFileURL(resolve(web, "glint.mjs")))).load({ font: true })
const PHONE = 356, LETTERS = 12 // as in bindings/publish/publish.c
const html = text => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;")
const safe = text => text.replace(/<(?=\/|!--|script)/gi, "\\u003c") // in JSON

// Returns the overlays of a figure's first picture: SVG elements for pages that have its width, and for narrow ones.
async function overlays(job, width, height) {
  const list = []
  for (const [name, wide] of [["wide", width], ["narrow", Math.min(width, PHONE)]]) {
    const layers = { width: wide, height: Math.round(height * wide / width), least: LETTERS }
    const { marks } = await job.render({ width, height, samples: 1, layers })
    if (marks) list.push(marks.replace("<svg", `<svg class="${name}" aria-hidden="true"`))
  }
  return list.join("\n")
}

// Returns an opening tag with the script and its parameters after it, and a link after the element.
async function inlined([, opening, src, rest]) {
  const path = join(scripts, src.replace(/^examples\//, "")), script = readFileSync(path, "utf8")
  if (/<\/script|<!--/i.test(script)) throw new Error(`${path}: has </script or <!--, which ends a script element`)
  const job = await glint.open(script, { name: basename(path) })
  const [width, height] = ["width", "height"].map(side => Number(new RegExp(` ${side}="(\\d+)"`).exec(opening)[1]))
  const marks = await overlays(job, width, height)
  job.close()
  return `${opening}<script type="text/x-lua" name="${html(basename(path))}">\n${script}</script>\n`
    + `<script type="application/json" class="params">${safe(JSON.stringify(job.params))}</script>\n${rest.replace("</glint-figure>", () => `${marks}</glint-figure>`)}\n`
    + `<p class="open"><a href="index.html#src=${html(src)}">Open ${html(src)} in the playground</a></p>`
}

const text = readFileSync(page, "utf8"), figures = /(<glint-figure src="([^"]*)"[^>]*>)([^]*?<\/glint-figure>)/g
const texts = await Promise.all([...text.matchAll(figures)].map(inlined))
process.stdout.write(text.replace(figures, () => texts.shift()))
