// Writes a page with the script of each figure inside its element, with the parameters of the script, and with a link to
// the playground, so that the page works from a disk and has its controls before the engine has started.
//   node inline.mjs PAGE SCRIPTS GLINT
// PAGE is a page with <glint-figure src="...">, SCRIPTS the folder of scripts, GLINT the command.
import { execFileSync } from "node:child_process"
import { readFileSync } from "node:fs"
import { join } from "node:path"

const [page, scripts, glint] = process.argv.slice(2)
const html = text => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;")
const safe = text => text.replace(/<(?=\/|!--|script)/gi, "\\u003c") // in JSON

process.stdout.write(readFileSync(page, "utf8").replace(/(<glint-figure src="([^"]*)"[^>]*>)([^]*?<\/glint-figure>)/g, (_, opening, src, rest) => {
  const path = join(scripts, src.replace(/^examples\//, "")), script = readFileSync(path, "utf8")
  if (/<\/script|<!--/i.test(script)) throw new Error(`${path}: has </script or <!--, which ends a script element`)
  const { params } = JSON.parse(execFileSync(glint, ["describe", path, "--json"], { encoding: "utf8" }))
  return `${opening}<script type="text/x-lua" name="${html(src.split("/").pop())}">\n${script}</script>\n`
    + `<script type="application/json" class="params">${safe(JSON.stringify(params))}</script>\n${rest}\n`
    + `<p class="open"><a href="index.html#src=${html(src)}">Open ${html(src)} in the playground</a></p>`
}))
