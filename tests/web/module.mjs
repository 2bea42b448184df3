// Tests the module of `make web` in node: its pictures equal the command's bit for bit, its errors have the same text,
// and no script or order of calls stops the page. module.sh runs this file with GLINT and WEB in the environment.
import assert from "node:assert/strict"
import { execFileSync } from "node:child_process"
import fs from "node:fs"
import path from "node:path"
import { pathToFileURL } from "node:url"
import { decode } from "./png.mjs"

const { GLINT, WEB, OUT } = process.env
const { load, GlintError } = await import(pathToFileURL(path.resolve(WEB, "glint.mjs")))
const glint = await load()
const data = Object.fromEntries(fs.readdirSync("scripts/data").map(name => [`data/${name}`, fs.readFileSync(`scripts/data/${name}`)]))
let bad = 0

async function test(name, run) {
  if (!name.includes(process.env.T ?? "")) return
  try {
    await run()
    console.log(`ok - ${name}`)
  } catch (error) {
    bad++
    console.log(`not ok - ${name}\n${String(error.stack ?? error).slice(0, 2000)}`)
  }
}

const native = (script, options, output) => execFileSync(GLINT, [script, ...options, "--quiet", "--force", "-o", output], { stdio: ["ignore", "pipe", "pipe"] })

// A .pfm as numbers, row by row from the top.
function readPfm(file) {
  const bytes = fs.readFileSync(file), [kind, size] = bytes.subarray(0, 64).toString("latin1").split("\n")
  const [width, height] = size.split(" ").map(Number), channels = kind === "PF" ? 3 : 1, row = width * channels
  const numbers = new Float32Array(bytes.buffer.slice(bytes.byteOffset + bytes.length - 4 * row * height, bytes.byteOffset + bytes.length))
  const out = new Float32Array(row * height)
  for (let y = 0; y < height; y++) out.set(numbers.subarray((height - 1 - y) * row, (height - y) * row), y * row)
  return out
}

const sameBits = (a, b) => a.length === b.length && Buffer.compare(Buffer.from(a.buffer, a.byteOffset, a.byteLength), Buffer.from(b.buffer, b.byteOffset, b.byteLength)) === 0

// ---- The pictures of the command ----

// Returns the pictures that golden.sh or gallery.sh makes, as [name, script, options].
function pictures(file, pattern) {
  return fs.readFileSync(file, "utf8").split("\n").flatMap(line => {
    const found = pattern.exec(line)
    const words = found?.[3].replaceAll('"', "").replaceAll("$out", OUT).split(/ +/).filter(word => word !== "")
    return found ? [[found[1], found[2], words]] : []
  })
}
const steps = ["ambient", "diffuse", "specular", "all"].map(step => [`workshop_${step}`, "workshop", ["--set", `step=${step}`]])
const golden = [...steps, ...pictures("tests/command/golden.sh", /^picture (\w+) scripts\/(\w+)\.lua(.*)$/)]
const quick = { furnace: ["--set", "steps=8"] } // the sums of its 40 steps take longer than all other pictures together
const notHere = new Set(["gr_room", "gr_scene"]) // only the command has the gr dialect
const gallery = pictures("tests/command/gallery.sh", /^picture ((\w+))(.*)$/)
const flake = `${OUT}/flake.nff`
execFileSync(GLINT, ["scripts/sphereflake.lua", "--set", "size=3", "--set", `nff=${flake}`, "-o", "none", "--quiet"])

// Converts options of the command line to the options of open and render.
function readOptions(words) {
  const set = {}, options = {}
  for (let i = 0; i < words.length; i += 2) {
    const value = words[i + 1]
    if (words[i] === "--set") set[value.slice(0, value.indexOf("="))] = value.slice(value.indexOf("=") + 1)
    else if (words[i] === "-f" || words[i] === "--frames") options.frame = Number(value)
    else if (words[i] === "--size") [options.width, options.height] = value.split("x").map(Number)
    else options[words[i].slice(2)] = value
  }
  return { set, options }
}

async function comparePicture(name, script, words, size, codes) {
  const { set, options } = readOptions([...size, ...words])
  const job = await glint.open(fs.readFileSync(`scripts/${script}.lua`, "utf8"), { name: `${script}.lua`, files: { ...data, [flake]: fs.readFileSync(flake) }, set, seconds: 300 })
  const image = await job.render({ ...options, passes: ["beauty", "depth"] })
  native(`scripts/${script}.lua`, [...size, ...words, "--passes", "depth"], `${OUT}/${name}.pfm`)
  const file = fs.readdirSync(OUT).find(other => other.startsWith(`${name}`) && /^(_\d+)?\.pfm$/.test(other.slice(name.length)))
  const depth = file.replace(/\.pfm$/, ".depth.pfm")
  assert(sameBits(image.plane("beauty"), readPfm(`${OUT}/${file}`)), "beauty has the bits of the .pfm")
  assert(sameBits(image.plane("depth"), readPfm(`${OUT}/${depth}`)), "depth has the bits of the .pfm")
  const plain = await job.render(options)
  job.close()
  assert(sameBits(plain.rgba, image.rgba), "the codes are the same without planes")
  const kept = codes && decode(fs.readFileSync(codes))
  if (kept && kept.bits === 8) {
    assert(sameBits(image.rgba, kept.rgba), "the codes are those of the .png")
    assert(sameBits(decode(image.png()).rgba, kept.rgba), "png() has them")
  }
}

for (const [name, script, words] of golden)
  if (!notHere.has(script)) await test(`golden ${name}`, () => comparePicture(name, script, words, ["--size", "64x48"], `tests/golden/${name}.png`))
for (const [name, script, words] of gallery)
  if (!notHere.has(script)) await test(`gallery ${name}`, () => comparePicture(`gallery_${name}`, script, words, ["--size", "80x50", ...quick[script] ?? []]))


// ---- The case of the twenty cylinders ----

const cylinders = fs.readFileSync("tests/web/cylinders.lua", "utf8")
await test("twenty cylinders are where they are", async () => {
  const job = await glint.open(cylinders, { name: "cylinders.lua" })
  const image = await job.render({ width: 160, height: 90, passes: "object_id" })
  job.close()
  native("tests/web/cylinders.lua", ["--size", "160x90", "--passes", "object_id"], `${OUT}/cylinders.pfm`)
  assert(sameBits(image.plane("object_id"), readPfm(`${OUT}/cylinders.object_id.pfm`)), "the same pixels")
  const count = id => image.plane("object_id").filter(other => other === id).length
  assert.deepEqual([count(1), count(2)], [469, 469])
})

// ---- Jobs ----

const ball = `local glint = require "glint"
local P = glint.params { radius = { 4, min = 1, max = 9, doc = "of the ball" }, kind = { "phong", choices = { "phong", "lambert" } } }
local red = glint.material { diffuse = { 0.8, 0.2, 0.2 }, specular = 0.7, shininess = 64, model = P.kind }
local lamp = glint.point_light { position = { 0, 20, 0 } }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 20 }, at = { 0, 0, 0 } }, ambient = 0.1, lamp,
  glint.sphere { center = { 0, 0, 0 }, radius = P.radius, material = red },
}
return glint.animation { scene = scene, width = 96, height = 64, frames = 12, fps = 10, cyclic = true, frame = function(t)
  lamp.position = { 10 * glint.cos(2 * math.pi * t), 15, 10 * glint.sin(2 * math.pi * t) }
end }
`
const planes = { passes: ["beauty"] }
const sameImages = (a, b) => sameBits(a.rgba, b.rgba) && sameBits(a.plane(), b.plane())

await test("what a script says of itself", async () => {
  const job = await glint.open(ball, { name: "ball.lua", set: { radius: 3 } })
  assert.deepEqual([job.frames, job.fps, job.width, job.height], [12, 10, 96, 64])
  assert.deepEqual(job.params, [
    { name: "kind", type: "string", default: "phong", value: "phong", choices: ["phong", "lambert"] },
    { name: "radius", type: "number", default: 4, value: 3, min: 1, max: 9, doc: "of the ball" },
  ])
  fs.writeFileSync(`${OUT}/ball.lua`, ball)
  const command = execFileSync(GLINT, ["explain", `${OUT}/ball.lua`, "--json", "--frame", "3", "--set", "radius=3"], { encoding: "utf8" })
  assert.equal(await job.explain({ frame: 3 }), command)
  job.close()
})

await test("frames, parameters and sizes in any order are fresh frames", async () => {
  const job = await glint.open(ball)
  const asks = [{ frame: 3 }, { frame: 7 }, { frame: 3, set: { radius: 5 } }, { frame: 3, set: { kind: "lambert" }, width: 50, height: 40 },
    { frame: 12, samples: 4 }, { frame: 3 }, { region: [10, 5, 40, 30] }, { frame: 3, transfer: "linear" }, { frame: 1 }]
  for (const ask of asks) {
    const fresh = await glint.open(ball)
    assert(sameImages(await job.render({ ...planes, ...ask }), await fresh.render({ ...planes, ...ask })), JSON.stringify(ask))
    fresh.close()
  }
  job.close()
})

await test("two workers render halves of a frame, the same bits", async () => {
  const jobs = await Promise.all([glint.open(ball), glint.open(ball)])
  const [upper, lower] = await Promise.all(jobs.map((job, i) => job.render({ region: [0, 32 * i, 96, 32] })))
  const whole = await jobs[0].render()
  assert(sameBits(whole.rgba, Uint8ClampedArray.from([...upper.rgba, ...lower.rgba])))
  for (const job of jobs) job.close()
})

await test("calls of scene:render are frames", async () => {
  const job = await glint.open(ball.replace(/return glint.animation.*/s, "for n = 1, 3 do red.shininess = n; scene:render { width = 40, height = 30 } end"))
  assert.deepEqual([job.frames, job.fps, job.width, job.height], [3, 24, 40, 30])
  const [first, last] = [await job.render(), await job.render({ frame: 3 })]
  assert(!sameBits(first.rgba, last.rgba))
  assert(sameBits((await job.render({ frame: 1 })).rgba, first.rgba))
  job.close()
})

await test("files and modules that the script was given, and warnings", async () => {
  const source = `local own = require "shapes.own"
    local text = assert(io.open("words/list.txt")):read "a"
    assert(not io.open "/etc/passwd" and not io.open "other.txt")
    print(text)
    local glint = require "glint"
    return glint.scene { camera = glint.camera { eye = { 3, 3, 3 }, at = { 0, 0, 0 } }, own(),
      glint.mesh { file = "data/cottage.obj", material = glint.material { diffuse = 2 } } }`
  const job = await glint.open(source, {
    files: { "words/list.txt": "one two", "shapes/own.lua": "return function() return require 'glint'.sphere { center = { 0, 0, 0 }, radius = 1 } end", "data/cottage.obj": data["data/cottage.obj"], "data/cottage.mtl": data["data/cottage.mtl"] },
  })
  assert.deepEqual(job.printed, ["one two"])
  assert(job.warnings.some(line => line.includes("diffuse")), job.warnings.join())
  await job.render({ width: 20, height: 20 })
  job.close()
})

// ---- Layers ----

const vectors = fs.readFileSync("tests/web/vectors.lua", "utf8")

await test("layers: the command's picture without overlays, and the overlays for a page", async () => {
  const job = await glint.open(vectors, { name: "vectors.lua" })
  const page = (width, height, least) => ({ width: 320, height: 200, layers: { width, height, least } })
  const images = [await job.render(page(640, 400, 12)), await job.render(page(390, 244, 12)), await job.render({ width: 320, height: 200 })]
  for (const [i, marks] of ["false", "false", "true"].entries()) {
    native("tests/web/vectors.lua", ["--size", "320x200", "--set", `marks=${marks}`], `${OUT}/vectors.png`)
    assert(sameBits(images[i].rgba, decode(fs.readFileSync(`${OUT}/vectors.png`)).rgba), `picture ${i}`)
  }
  const numbers = (svg, pattern) => [...svg.matchAll(pattern)].map(found => Number(found[1]))
  const [wide, narrow] = images.map(image => image.marks)
  assert.equal(images[2].marks, "")
  assert.match(wide, /^<svg [^>]*viewBox="0 0 640 400"/)
  assert.match(narrow, /^<svg [^>]*viewBox="0 0 390 244"/)
  assert(narrow.includes(">s") || narrow.includes("size 16"), "the label's text")
  // of the arrow behind the ball, only the part above the ball is drawn; the axis is at the page's middle
  const [x, y] = /<path d="M([\d.]+) ([\d.]+)L/.exec(wide).slice(1).map(Number)
  const k = 200 / Math.tan(18 * Math.PI / 180) // pixels of a unit length at the distance 1
  const limb = Math.tan(Math.asin(1 / Math.sqrt(64.25)) - Math.atan(0.5 / 8)) // slope of the line of sight that touches the ball
  assert(Math.abs(x - 320) < 0.01 && Math.abs(y - (200 - k * limb)) < 1, `the arrow begins at ${x}, ${y}; ${200 - k * limb}`)
  assert(Math.abs(/<path d="M([\d.]+) /.exec(narrow)[1] - 195) < 0.01)
  for (const size of numbers(narrow, /font-size="([\d.]+)"/g)) assert(size >= 12, `letters of ${size} pixels`)
  // with the font, letters are the command's with DejaVu Sans
  const lettered = await (await load({ font: true })).open(vectors, { name: "vectors.lua" }), image = await lettered.render({ width: 320, height: 200 })
  const { GLINT_FONT, ...environment } = process.env
  execFileSync(GLINT, ["tests/web/vectors.lua", "--size", "320x200", "--quiet", "--force", "-o", `${OUT}/vectors.png`], { env: environment })
  assert(sameBits(image.rgba, decode(fs.readFileSync(`${OUT}/vectors.png`)).rgba), "the command's letters")
  const { marks } = await lettered.render(page(390, 244, 12))
  assert.match(marks, /font-family="DejaVu Sans, /)
  for (const size of numbers(marks, /font-size="([\d.]+)"/g)) assert(size >= 12, `letters of ${size} pixels`)
  const scripts = numbers((await lettered.render(page(640, 400, 0))).marks, /font-size="([\d.]+)"/g)
  assert(scripts.includes(16) && scripts.includes(11.2), `sizes ${scripts}`)
  lettered.close()
  await assert.rejects(job.render(page(0, 10, 12)), /page.width: expected 1 \.\. 65535, got 0/)
  job.close()
})

await test("layers: one factor for all letters of a narrow page, and space for a chart's curves", async () => {
  const figure = `local glint = require "glint"
    return glint.animation { frames = 1, width = 800, height = 450, scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } },
      glint.label { text = "$k_s$", size = 18, at = "top" }, glint.label { text = "plain $k_s$", at = "bottom" },
      glint.chart { extent = { 300, 200 }, at = "right", title = "t", x = { 0, 1 }, y_label = "y", series = { { y = { 0, 1 } } } } } }`
  const job = await (await load({ font: true })).open(figure, { name: "sizes.lua" })
  const marks = async (width, height, least) => (await job.render({ samples: 1, layers: { width, height, least } })).marks
  const sizesOf = svg => [...svg.matchAll(/font-size="([\d.]+)"[^>]*>(k|plain)/g)].map(found => Number(found[1]))
  const curve = svg => [...svg.matchAll(/<path d="M([\d.]+) ([\d.]+)L([\d.]+) ([\d.]+)/g)].map(found => found.slice(1).map(Number)).map(([a, b, c, d]) => [c - a, b - d])
  // 450 / 36 points are 12.5 pixels of the script's picture
  for (const width of [800, 400, 320]) {
    const found = sizesOf(await marks(width, 450 * width / 800, 12)), factor = Math.max(width / 800, 14 / 12.5)
    for (const [i, own] of [18, 12.5].entries()) assert(Math.abs(found[i] - factor * own) < 0.01, `letters of ${found} on a page of ${width}`)
  }
  const [[whole]] = curve(await marks(800, 450, 0)), [[half]] = curve(await marks(400, 225, 12))
  assert(half > 0.45 * whole, `curves ${half} wide on half a page, ${whole} on the whole`)
  assert(!(await marks(60, 34, 12)).includes("<rect"), "no paper without curves")
  job.close()
})

// ---- Steps ----

const soft = fs.readFileSync("tests/web/soft.lua", "utf8")
async function stepsOf(job, options) {
  const found = []
  for await (const image of job.steps(options)) if (image !== found.at(-1)) found.push(image)
  return found
}

await test("steps are pictures of --samples n, with the errors of --until-light", async () => {
  const job = await glint.open(soft), found = await stepsOf(job)
  assert.deepEqual(found.map(image => image.samples), [1, 2, 4, 6])
  for (const { samples, ownSamples, rgba, error } of found) {
    native("tests/web/soft.lua", ["--samples", String(samples)], `${OUT}/soft.png`)
    assert(sameBits(rgba, decode(fs.readFileSync(`${OUT}/soft.png`)).rgba), `the codes of ${samples} samples`)
    assert.equal(ownSamples, 6)
    if (samples === 1) assert.equal(error, undefined)
    else assert.equal(error, errorOf(samples))
  }
  const full = await job.render()
  assert(sameBits(full.rgba, found.at(-1).rgba), "the last one is the picture of render")
  assert.deepEqual((await stepsOf(job, { width: 16, height: 9 })).map(image => image.samples), [6], "a quick picture has no steps")
  job.close()
})

// The error that --until-light estimates for a picture of soft.lua.
function errorOf(samples) {
  const lines = execFileSync(GLINT, ["tests/web/soft.lua", "--samples", String(samples), "--until-light", "1e-9", "-o", "none", "--json"],
    { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] })
  return Number([...lines.matchAll(/"error":([0-9.e-]+)/g)].at(-1)[1])
}

await test("no steps for one sample, nor for a call of scene:render", async () => {
  for (const source of [soft.replace("samples = 6, f", "samples = 1, f"), soft.replace("return glint.animation {", "local film = {") +
    "film.scene:render { width = 320, height = 180, samples = 6 }"]) {
    const job = await glint.open(source), answers = []
    for await (const image of job.steps()) answers.push([image.samples === image.ownSamples, image.error])
    assert.deepEqual(answers, [[true, undefined]])
    job.close()
  }
})

await test("steps end when the loop is left, and when they are cancelled", async () => {
  const job = await glint.open(soft), stop = new AbortController()
  for await (const image of job.steps({ samples: 4096 })) if (image.samples === 2) break
  const start = performance.now(), step = job.steps({ width: 6000, height: 4000, signal: stop.signal }).next() // takes minutes
  setTimeout(() => stop.abort(), 100)
  await assert.rejects(step, { name: "AbortError" })
  assert.equal((await job.render({ width: 32, height: 18 })).samples, 6)
  assert(performance.now() - start < 20000)
  job.close()
})

await test("500 renders need no more memory than the first", async () => {
  const job = await glint.open(ball)
  let memory = 0
  for (let n = 0; n < 500; n++) {
    const image = await job.render({ frame: 1 + n % 12, set: { radius: 2 + n % 5 }, width: 160, height: 120 })
    if (n === 60) memory = image.memory
    if (n > 60) assert.equal(image.memory, memory, `render ${n}`)
  }
  job.close()
})

// ---- What goes wrong ----

const refused = (promise, file, line, message) => assert.rejects(promise, error => {
  assert(error instanceof GlintError, String(error))
  assert.deepEqual([error.file, error.line], [file, line], error.message)
  assert(message.test(error.message), error.message)
  return true
})

// The command gives the same message for the same script.
await test("wrong scripts: the words of the command", async () => {
  const wrong = {
    syntax: "local x = = 2", raised: "\n\nerror 'no'", nothing: "return 7", field: ball.replace("shininess", "shinyness"),
    range: ball.replace("shininess = 64", "shininess = -1"), missing: "require 'glint'.mesh { file = 'none.obj' }",
    frame: ball.replace("lamp.position = {", "lamp.position = nil + {"),
  }
  for (const [name, source] of Object.entries(wrong)) {
    fs.writeFileSync(`${OUT}/${name}.lua`, source)
    let said
    try {
      execFileSync(GLINT, [`${name}.lua`, "-o", "none", "--quiet"], { cwd: OUT, encoding: "utf8", stdio: "pipe" })
    } catch (error) {
      said = error.stderr.replace(/^glint: error: /, "").trim()
    }
    await assert.rejects(async () => {
      const job = await glint.open(source, { name: `${name}.lua` })
      try { await job.render() } finally { job.close() }
    }, error => error instanceof GlintError && (assert.equal(error.message, said), true))
  }
  await refused(glint.open("\n\nlocal x = = 2", { name: "a.lua" }), "a.lua", 3, /unexpected symbol/)
  await refused(glint.open(ball, { name: "folder/a.lua", set: { radios: 3 } }), undefined, undefined, /radios.*radius/)
  await refused(glint.open(ball, { set: { radius: 30 } }), "scene.lua", 2, /^--set radius: number 1/)
})

await test("the Lua of --untrusted", async () => {
  await glint.open(`assert(not os.execute and not io.popen and not os.exit and not debug and not package and not dofile and not os.getenv)
    assert(not load("\\27Lua"))
    return require "glint".scene { camera = require "glint".camera { eye = { 0, 0, 1 }, at = { 0, 0, 0 } } }`).then(job => job.close())
  await refused(glint.open("require 'socket'"), "scene.lua", 1, /module 'socket' not found/)
})

await test("recursion without an end is an error", async () => {
  await assert.rejects(glint.open("local function f() return 1 + f() end\nf()"), { name: "GlintError", message: /stack overflow|not enough memory/ })
  await refused(glint.open("local function f(s) return (s:gsub('.', f)) end\nf 'a'"), "scene.lua", 1, /C stack overflow/)
  await refused(glint.open("local t = {}\nwhile true do t[#t + 1] = ('a'):rep(1e6) .. #t end"), undefined, undefined, /not enough memory/)
})

await test("an error leaves the job as it was", async () => {
  const job = await glint.open(ball), before = await job.render({ ...planes, frame: 2 })
  await refused(job.render({ frame: 13 }), undefined, undefined, /1 \.\. 12, got '13'/)
  await refused(job.render({ samples: 0 }), undefined, undefined, /samples/)
  await refused(job.render({ sample: 1 }), undefined, undefined, /sample/)
  await refused(job.render({ passes: ["colour"] }), undefined, undefined, /passes/)
  await refused(job.render({ set: { radius: 0 } }), "scene.lua", 2, /^--set radius: number 1/)
  assert.throws(() => before.plane("depth"), GlintError)
  assert(sameImages(await job.render({ ...planes, frame: 2 }), before))
  job.close()
})

await test("a script without an end is stopped, wherever it is", async () => {
  await refused(glint.open("local n = 0\nwhile true do n = n + 1 end", { name: "loop.lua", seconds: 0.2 }), "loop.lua", 2, /took longer than 0.2 s/)
  await refused(glint.open("while true do pcall(function() while true do end end) end", { name: "loop.lua", seconds: 0.2 }), "loop.lua", 1, /took longer/)
  await refused(glint.open("coroutine.wrap(function() while true do end end)()", { seconds: 0.2 }), "scene.lua", 1, /took longer/)
  await refused(glint.open("string.find(('a'):rep(40), ('a?'):rep(40) .. ('a'):rep(40))", { seconds: 0.2 }), undefined, undefined, /took longer/)
  const job = await glint.open(ball.replace("lamp.position = {", "while P.radius == 6 do end lamp.position = {"), { seconds: 1 })
  const before = await job.render(planes)
  await refused(job.render({ set: { radius: 6 } }), "scene.lua", 10, /took longer/)
  assert(sameImages(await job.render(planes), before))
  job.close()
})

await test("a render is cancelled, and the job goes on", async () => {
  const job = await glint.open(ball), before = await job.render({ ...planes, frame: 2 })
  const late = AbortSignal.timeout(100), start = performance.now()
  await assert.rejects(job.render({ width: 3000, height: 2000, samples: 64, signal: late }), { name: "TimeoutError" })
  assert(performance.now() - start < 2000)
  await assert.rejects(job.render({ signal: AbortSignal.abort() }), { name: "AbortError" })
  const stop = new AbortController()
  const [slow, next] = [job.render({ width: 3000, height: 2000, samples: 64 }), job.render({ frame: 5, signal: stop.signal })]
  stop.abort() // the second render still waits for the first
  await assert.rejects(next, { name: "AbortError" })
  job.close()
  await assert.rejects(slow, GlintError)
  await assert.rejects(job.render(), /the job is closed/)
  const other = await glint.open(ball)
  assert(sameImages(await other.render({ ...planes, frame: 2 }), before))
  other.close()
})

console.log(`${bad ? "not all" : "all"} is well`)
process.exit(bad ? 1 : 0)
