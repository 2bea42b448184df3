// Makes the examples of the playground: the gallery's scripts that the module can open, with the files they read.
//   node examples.mjs WEB SCRIPTS
// WEB contains the module. The scripts, their files and index.json are written to WEB/examples.
import { cpSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs"
import { dirname, join, resolve } from "node:path"
import { pathToFileURL } from "node:url"

const [web, scripts] = process.argv.slice(2)
const { load } = await import(pathToFileURL(resolve(web, "glint.mjs")))
const glint = await load()

const BUILD_S = 300 // the build machine may be busy
const data = readdirSync(join(scripts, "data")).map(name => `data/${name}`)
const out = join(web, "examples")

// Returns the beginning of the leading comment, up to its first stop.
function titleOf(text) {
  const first = text.match(/^-- (.*(?:\n-- .*)*)/)?.[1].replaceAll("\n-- ", " ") ?? ""
  return first.split(/[.:;](?:\s|$)/)[0]
}

const index = []
const isExample = file => file.endsWith(".lua") && !file.startsWith("gr_") && file !== "furnace.lua" // too slow
for (const name of readdirSync(scripts).filter(isExample).sort()) {
  const text = readFileSync(join(scripts, name), "utf8")
  // A script names a file that it reads, or another file that refers to it (an .mtl).
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
