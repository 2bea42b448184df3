// The examples of the playground: the scripts of the gallery that the module can open, with the files they read.
//   node examples.mjs WEB SCRIPTS
// WEB has the module; the scripts, their files and index.json go to WEB/examples.
import { cpSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs"
import { dirname, join, resolve } from "node:path"
import { pathToFileURL } from "node:url"

const [web, scripts] = process.argv.slice(2)
const { load } = await import(pathToFileURL(resolve(web, "glint.mjs")))
const glint = await load()

const BUILD_S = 300 // the machine that builds may be busy
const data = readdirSync(join(scripts, "data")).map(name => `data/${name}`)
const out = join(web, "examples")

// Returns the first words of the comment at the top, up to its first stop.
function titleOf(text) {
  const first = text.match(/^-- (.*(?:\n-- .*)*)/)?.[1].replaceAll("\n-- ", " ") ?? ""
  return first.split(/[.:;](?:\s|$)/)[0]
}

const index = []
const isExample = file => file.endsWith(".lua") && !file.startsWith("gr_") && file !== "furnace.lua" // which computes for longer than a page waits
for (const name of readdirSync(scripts).filter(isExample).sort()) {
  const text = readFileSync(join(scripts, name), "utf8")
  // A file is read by its name, or by the name of another file that is read (an .mtl).
  const files = data.filter(file => text.includes(file) || text.includes(file.replace(/\.[^.]*$/, ".")))
  const given = Object.fromEntries(files.map(file => [file, new Uint8Array(readFileSync(join(scripts, file)))]))
  try {
    const job = await glint.open(text, { name, files: given, seconds: BUILD_S })
    await job.render({ width: 32, height: 18, samples: 1 })
    job.close()
  } catch (error) {
    console.log(`  ${name} is left out: ${error.message.split("\n")[0]}`)
    continue
  }
  index.push({ name, title: titleOf(text), files })
  for (const file of [name, ...files]) {
    mkdirSync(dirname(join(out, file)), { recursive: true })
    cpSync(join(scripts, file), join(out, file))
  }
}
writeFileSync(join(out, "index.json"), JSON.stringify(index, null, 1))
