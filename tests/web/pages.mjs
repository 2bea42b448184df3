// Tests the pages in Chromium: pictures equal the command's, sliders work, errors are shown at their line, and the
// console stays empty.
//   node pages.mjs WEB GLINT SCRIPTS WORK
// WEB is the output folder of `make web`, GLINT the command, SCRIPTS the folder of scripts, WORK a folder for pictures.
import { execFileSync } from "node:child_process"
import { createServer } from "node:http"
import { createReadStream, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs"
import { extname, join, normalize, resolve } from "node:path"
import { chromium } from "playwright-core"

const [web, glint, scripts, work] = process.argv.slice(2)
rmSync(work, { recursive: true, force: true })
mkdirSync(work, { recursive: true })

let passed = 0, failed = 0
function check(holds, what) {
  if (holds) passed++
  else failed++
  if (!holds) console.log(`failed: ${what}`)
}

// ---- A server of the folder ----

const types = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".json": "application/json",
  ".wasm": "application/wasm", ".png": "image/png", ".svg": "image/svg+xml", ".lua": "text/plain" }
const server = createServer((request, response) => {
  const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname))
  const file = path.startsWith("/native/") ? join(work, path.slice("/native/".length)) : join(web, path.endsWith("/") ? `${path}index.html` : path)
  if (!existsSync(file)) {
    response.writeHead(404)
    return response.end()
  }
  response.writeHead(200, { "content-type": types[extname(file)] ?? "application/octet-stream" })
  createReadStream(file).pipe(response)
})
await new Promise(done => server.listen(0, "127.0.0.1", done))
const base = `http://127.0.0.1:${server.address().port}`

// ---- Chromium ----

const quiet = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync"]
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: quiet })
const LIMIT_MS = 60000

async function open(address, viewport = { width: 1200, height: 800 }, deviceScaleFactor = 1) {
  const context = await browser.newContext({ viewport, deviceScaleFactor })
  const page = await context.newPage()
  page.setDefaultTimeout(LIMIT_MS)
  page.messages = []
  page.on("console", message => {
    // "willReadFrequently" is a warning about this test's own reads of the canvas
    if (!message.text().includes("willReadFrequently")) page.messages.push(`${message.type()}: ${message.text()}`)
  })
  page.on("pageerror", error => page.messages.push(`error: ${error.message}`))
  await page.addInitScript(() => document.addEventListener("glint-render", ({ target, detail }) => { target.isFull = !detail.coarse }, true))
  await page.goto(address)
  return page
}

async function close(page, what) {
  check(page.messages.length === 0, `${what}: the console has: ${page.messages.join(" | ")}`)
  await page.context().close()
}

// How many 8-bit values differ between a canvas and a picture of the command; -1 where the sizes differ.
function differing(page, canvas, name) {
  return canvas.evaluate(async (shown, address) => {
    const picture = new Image()
    picture.src = address
    await picture.decode()
    if (picture.naturalWidth !== shown.width || picture.naturalHeight !== shown.height) return -1
    const native = document.createElement("canvas")
    native.width = shown.width
    native.height = shown.height
    native.getContext("2d").drawImage(picture, 0, 0)
    const [a, b] = [shown, native].map(one => one.getContext("2d").getImageData(0, 0, shown.width, shown.height).data)
    let count = 0
    for (let i = 0; i < a.length; i++) count += a[i] !== b[i]
    return count
  }, `${base}/native/${name}`)
}

// Waits until a canvas shows a picture of the command, and checks that it does.
async function shows(page, canvas, name, what) {
  const start = Date.now()
  let count
  do {
    count = await differing(page, canvas, name)
    if (count !== 0) await page.waitForTimeout(100)
  } while (count !== 0 && Date.now() - start < LIMIT_MS)
  check(count === 0, `${what}: ${count} values differ`)
}

const AT_REST = ["--samples", "4"] // of a script with fewer
let pictures = 0
function native(script, ...options) {
  const name = `${++pictures}.png`
  execFileSync(glint, [resolve(scripts, script), ...options, "--force", "--quiet", "-o", join(work, name)],
    { env: { ...process.env, GLINT_FONT: "bitmap" } })
  return readdirSync(work).find(file => file === name || file.startsWith(`${pictures}_`))
}

// Makes a copy of a script without its overlays, which the pages draw in a layer of their own.
function bare(script, folder = scripts) {
  const kinds = ["label", "colorbar", "axes", "arrow", "line", "arc", "polyline", "lobe", "path", "frustum", "chart"]
  const none = kinds.map(kind => `glint.${kind} = function() return glint.group {} end`).join(" ")
  const path = join(work, `bare_${script.replaceAll("/", "_")}`)
  writeFileSync(path, `do local glint = require "glint" ${none} end\n${readFileSync(join(folder, script), "utf8")}`)
  return path
}

// ---- The playground ----

const ready = page => page.waitForFunction(() => document.getElementById("state").textContent === "ready")
const canvasOf = page => page.locator("#picture")

async function playground() {
  const start = Date.now()
  const page = await open(`${base}/index.html`)
  await page.waitForFunction(() => document.getElementById("time").textContent !== "")
  console.log(`playground: first picture after ${Date.now() - start} ms`)
  await ready(page)
  console.log(`playground: full picture after ${Date.now() - start} ms`)
  await shows(page, canvasOf(page), native("moving_light.lua", "--size", "640x360", "-f", "1", ...AT_REST), "playground: the first picture")

  await page.locator(".cm-line").first().waitFor()
  const loaded = await page.evaluate(() => performance.getEntriesByType("resource").sort((a, b) => a.startTime - b.startTime).map(one => one.name.split("/").pop()))
  check(["glint.wasm", "moving_light.lua", "worker.mjs"].every(name => loaded.indexOf("editor.js") > loaded.indexOf(name)), `playground: the editor comes last: ${loaded}`)
  check((await page.locator(".cm-content").innerText()).includes("glint.animation"), "playground: the editor has the script")

  const slider = page.getByLabel("radius")
  await slider.focus()
  await page.keyboard.press("End")
  await shows(page, canvasOf(page), native("moving_light.lua", "--size", "640x360", "-f", "1", "--set", "radius=40", ...AT_REST), "playground: the slider's picture")

  await page.selectOption("#pass", "depth")
  await page.waitForTimeout(400)
  await ready(page)
  check(await page.locator("#error").isHidden(), "playground: the depth pass")

  await page.getByRole("tab", { name: "What this scene needs" }).click()
  await page.waitForFunction(() => document.getElementById("pane-explain").textContent.includes("hard shadow"))
  await page.getByRole("tab", { name: "Picture" }).click()
  await playgroundErrors(page)
  await close(page, "playground")
}

// Replaces the editor's text by typing.
async function type(page, text) {
  await page.locator(".cm-content").click()
  await page.keyboard.press("Control+A")
  await page.keyboard.insertText(text)
}

const failing = text => page => page.waitForFunction(part => {
  const box = document.getElementById("error")
  return !box.hidden && box.textContent.includes(part)
}, text)

async function playgroundErrors(page) {
  await type(page, 'local glint = require "glint"\nlocal red = glint.material { shininess = -1 }\n')
  await failing("material.shininess")(page)
  check((await page.locator("#error").textContent()).includes(":2:"), "playground: the error names its line")
  check(await page.locator(".cm-line").nth(1).locator(".cm-lintRange-error").count() > 0, "playground: the error is marked at its line")
  await type(page, "while true do end\n")
  await failing("took longer")(page)
  check(true, "playground: an endless loop is stopped")
  await page.selectOption("#examples", "workshop.lua")
  await ready(page)
  check(await page.locator("#error").isHidden(), "playground: lives on after an endless loop")
}

async function sharing() {
  const page = await open(`${base}/index.html`)
  await ready(page)
  await type(page, readFileSync(join(scripts, "course/lambert.lua"), "utf8"))
  await page.waitForTimeout(600)
  await ready(page)
  await page.getByRole("button", { name: "Copy link" }).click()
  await page.waitForFunction(() => location.hash.startsWith("#script="))
  const link = page.url()
  const other = await open(link)
  await ready(other)
  await shows(other, canvasOf(other), native("course/lambert.lua", "--size", "640x360", ...AT_REST), "a shared link shows the script's picture")
  const [download] = await Promise.all([other.waitForEvent("download"), other.getByRole("button", { name: "Save picture" }).click()])
  await download.saveAs(join(work, "saved.png"))
  const saved = await codesOf(other, join(work, "saved.png"))
  check(same(saved, await codesOf(other, join(work, native("course/lambert.lua", "--size", "640x360")))), "the saved picture is the command's")
  await close(page, "sharing")
  await close(other, "shared")
}

// ---- Figures and the course ----

// Waits for the full picture of a figure after `act`.
async function rendered(figure, act) {
  await figure.evaluate((one, limit) => { // listens before `act` begins
    one.done = new Promise((resolve, reject) => {
      one.addEventListener("glint-render", event => event.detail.coarse || resolve())
      one.addEventListener("glint-error", event => reject(event.detail.error))
      setTimeout(() => reject(new Error("no full picture")), limit)
    })
  }, LIMIT_MS)
  await act()
  await figure.evaluate(one => one.done)
}

async function figure() {
  const page = await open(`${base}/figure.html`)
  const one = page.locator("glint-figure")
  const canvas = one.locator("canvas")
  await canvas.waitFor({ state: "visible" })
  await shows(page, canvas, native("moving_light.lua", "--size", "640x360", "-f", "1", ...AT_REST), "figure: the first picture")
  await one.getByLabel("height").focus()
  await rendered(one, () => page.keyboard.press("Home"))
  await shows(page, canvas, native("moving_light.lua", "--size", "640x360", "-f", "1", "--set", "height=5", ...AT_REST), "figure: the slider's picture, by the keyboard")
  await one.getByRole("button", { name: "Play" }).click()
  await page.waitForFunction(() => document.querySelector("glint-figure").frame > 3)
  await rendered(one, () => one.getByRole("button", { name: "Pause" }).click())
  const frame = await one.evaluate(element => element.frame)
  await shows(page, canvas, native("moving_light.lua", "--size", "640x360", "-f", String(frame), "--set", "height=5", ...AT_REST), `figure: frame ${frame}, after playing`)
  await rendered(one, () => one.getByRole("button", { name: "Reset" }).click())
  check(await canvas.getAttribute("aria-label") !== "", "figure: the canvas has a text for screen readers")
  await close(page, "figure")
}

async function course() {
  const page = await open(`${base}/course.html`)
  const figures = page.locator("glint-figure")
  for (let i = 0; i < await figures.count(); i++) {
    const one = figures.nth(i)
    await one.scrollIntoViewIfNeeded()
    await one.locator("canvas").waitFor({ state: "visible" })
    const [src, width, height] = await Promise.all(["src", "width", "height"].map(name => one.getAttribute(name)))
    const own = Number(/samples = (\d+)/.exec(readFileSync(join(scripts, src), "utf8"))?.[1] ?? 1)
    await shows(page, one.locator("canvas"), native(bare(src), "--size", `${width}x${height}`, ...own < 4 ? AT_REST : []), `course: ${src}`)
    await page.screenshot({ path: join(work, `course-${i + 1}.png`) })
  }
  await close(page, "course")
}

async function phone() {
  for (const name of ["index.html", "figure.html", "course.html"]) {
    const page = await open(`${base}/${name}`, { width: 390, height: 844 })
    await page.waitForTimeout(1500)
    const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)
    check(over <= 0, `${name} is ${over} pixels wider than a phone`)
    await page.screenshot({ path: join(work, `phone-${name}.png`) })
    await close(page, `phone: ${name}`)
  }
}

// ---- A published page, opened from a file ----

const run = (...words) => execFileSync(glint, words, { cwd: work, stdio: "pipe", env: { ...process.env, GLINT_FONT: "bitmap", GLINT_WEB: web, LUA_PATH: "./?.lua" } })

// The 8-bit values that a figure shows, and those of the command's picture of the script.
const codesShown = figure => figure.locator("canvas").evaluate(shown => [...shown.getContext("2d").getImageData(0, 0, shown.width, shown.height).data])
function codesExpected(page, script, ...words) {
  run(script, "--size", "320x180", "-f", "1", "--force", "--quiet", "-o", "expected_####.png", ...AT_REST, ...words)
  return codesOf(page, join(work, "expected_0001.png"))
}

async function published() {
  writeFileSync(join(work, "tricky.lua"), TRICKY)
  writeFileSync(join(work, "shade.lua"), "return 0.25 -- a module beside the script\n")
  const path = join(work, "page.html")
  run("publish", "tricky.lua", "-o", "page.html", "--size", "320x180", "--title", "Lamps & <tags>", "--source", "--set", "height=9")
  check(statSync(path).size <= 2.5e6, `the published page has ${statSync(path).size} bytes`)
  const page = await open(`file://${path}`)
  const one = page.locator("glint-figure")
  await one.locator("canvas").waitFor({ state: "visible" })
  check(same(await codesShown(one), await codesExpected(page, "tricky.lua", "--set", "height=9")), "published: the picture, with the values of --set")
  check(await page.title() === "Lamps & <tags>" && await page.locator("details").count() === 1, "published: title and script")
  await one.getByLabel("height").focus()
  await rendered(one, () => page.keyboard.press("Home"))
  check(same(await codesShown(one), await codesExpected(page, "tricky.lua", "--set", "height=4")), "published: the slider's picture")
  await close(page, "published")
}

// With --live, the pages of other commands contain the same figure.
async function live() {
  writeFileSync(join(work, "sweep.lua"), SWEEP)
  run("sweep.lua", "-o", "swept.png", "--live")
  run("cost", "sweep.lua", "--report", "study", "--quick", "--knobs", "samples", "--live")
  for (const name of ["sheet.html", "study/index.html"]) {
    const page = await open(`file://${join(work, name)}`)
    const one = page.locator("glint-figure")
    await one.scrollIntoViewIfNeeded()
    await one.locator("canvas").waitFor({ state: "visible" })
    await one.getByLabel("height").focus()
    await rendered(one, () => page.keyboard.press("Home"))
    check(same(await codesShown(one), await codesExpected(page, "sweep.lua", "--set", "height=4")), `${name}: the slider's picture`)
    await page.screenshot({ path: join(work, `live-${name.replace("/", "-")}.png`), fullPage: true })
    await close(page, name)
  }
}

// Opens a published page of tests/web/soft.lua with other samples. The figure's `found` gets its pictures since the last
// move of the slider; without those that only add an error, but `errors` gets the notes of these.
async function openSoft(samples) {
  const name = `soft_${samples}`
  writeFileSync(join(work, `${name}.lua`), readFileSync(join(scripts, "../tests/web/soft.lua"), "utf8").replace("samples = 6, f", `samples = ${samples}, f`))
  run("publish", `${name}.lua`, "-o", `${name}.html`)
  const page = await open(`file://${join(work, `${name}.html`)}`), one = page.locator("glint-figure")
  await one.evaluate(figure => {
    figure.setAttribute("timing", "")
    const clear = () => Object.assign(figure, { found: [], errors: [] })
    clear()
    figure.shadowRoot.addEventListener("input", clear, { capture: true })
    figure.addEventListener("glint-render", ({ detail: { image, coarse } }) => {
      const canvas = figure.shadowRoot.querySelector("canvas"), note = figure.shadowRoot.querySelector(".timing")
      if (image.error !== undefined) return figure.errors.push(note.textContent)
      figure.found.push({ samples: image.samples, isCoarse: coarse && image.ownSamples === 1,
        note: note.style.visibility === "hidden" ? "" : note.textContent,
        codes: [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data] })
    })
  })
  await one.getByLabel("height").focus()
  return { page, one, name: `${name}.lua` }
}

const foundIn = async one => (await one.evaluate(figure => figure.found)).filter(picture => !picture.isCoarse)

async function steps() {
  const { page, one, name } = await openSoft(6)
  await page.keyboard.press("Home")
  await page.waitForFunction(() => document.querySelector("glint-figure").errors.length === 3)
  const found = await foundIn(one)
  check(found.map(picture => picture.samples).join() === "1,2,4,6", `steps: ${found.map(picture => picture.samples)}`)
  for (const { samples, codes, note } of found) {
    check(same(codes, await codesExpected(page, name, "--set", "height=4", "--samples", String(samples))), `steps: the picture of ${samples} samples`)
    check(note.startsWith(`${samples} of 6 samples`), `steps: the note '${note}'`)
  }
  const errors = await one.evaluate(figure => figure.errors)
  check(errors.every((note, i) => note.startsWith(`${found[i + 1].samples} of 6 samples, estimated error 0.0`)), `steps: ${errors}`)
  for (const [width, height] of [[1200, 800], [390, 844]]) {
    await page.setViewportSize({ width, height })
    await page.screenshot({ path: join(work, `steps-${width}.png`) })
  }
  await close(page, "steps")
  await oneSample()
  await cancelled()
}

// A picture of one sample gets four at rest, which smooth its edges.
async function oneSample() {
  const { page, one, name } = await openSoft(1)
  await page.keyboard.press("Home")
  await page.waitForFunction(() => document.querySelector("glint-figure").found.some(picture => picture.samples === 4))
  const found = await foundIn(one)
  check(same(found.at(-1).codes, await codesExpected(page, name, "--set", "height=4")), "one sample: four samples at rest")
  await close(page, "one sample")
}

async function cancelled() {
  const { page, one } = await openSoft(256)
  const has = samples => page.waitForFunction(wanted => document.querySelector("glint-figure").found.some(picture => picture.samples === wanted), samples)
  await page.keyboard.press("End")
  await has(4)
  const start = Date.now()
  await page.keyboard.press("Home")
  await page.waitForFunction(() => document.querySelector("glint-figure").found.length > 0)
  console.log(`steps: the picture of a change after ${Date.now() - start} ms`)
  await has(4)
  const found = await foundIn(one)
  check(found.slice(0, 3).map(picture => picture.samples).join() === "1,2,4", `a change ends the steps: ${found.map(picture => picture.samples)}`)
  await close(page, "cancelled")
}

const TRICKY = `local glint = require "glint"
local P = glint.params { height = { 8, min = 4, max = 12, doc = "</script><b>&" } }
return glint.animation { width = 64, height = 36, scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 8 }, at = { 0, 0, 0 } }, ambient = require "shade",
  glint.point_light { position = { 3, P.height, 5 } }, glint.sphere { center = { 0, 0, 0 }, radius = 1.5 } } }
`

const SWEEP = `local glint = require "glint"
local P = glint.params { height = { 8, min = 4, max = 12 } }
local red = glint.material { diffuse = { 0.8, 0.2, 0.2 }, specular = 0.6 }
return glint.sweep { width = 320, height = 180, over = { { red, "shininess", { 8, 64 } } }, sheet = { output = "sheet.html" }, scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 8 }, at = { 0, 0, 0 } }, ambient = 0.1,
  glint.point_light { position = { 3, P.height, 5 } }, glint.sphere { center = { 0, 0, 0 }, radius = 1.5, material = red } } }
`

const same = (a, b) => a.length === b.length && a.every((value, i) => value === b[i])

// The 8-bit values of a picture on disk, as the browser decodes them.
function codesOf(page, path) {
  return page.evaluate(async base64 => {
    const picture = new Image()
    picture.src = `data:image/png;base64,${base64}`
    await picture.decode()
    const canvas = document.createElement("canvas")
    canvas.width = picture.naturalWidth
    canvas.height = picture.naturalHeight
    canvas.getContext("2d").drawImage(picture, 0, 0)
    return [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data]
  }, readFileSync(path).toString("base64"))
}

// ---- A hand on a slider ----

// Figures in a page of their own: what a reader may see while a control moves and when it rests.
const FIGURES = {
  "vectors.lua": ["shininess", readFileSync(join(scripts, "../tests/web/vectors.lua"), "utf8")],
  "soft.lua": ["height", readFileSync(join(scripts, "../tests/web/soft.lua"), "utf8").replace("samples = 6, f", "samples = 1, f")],
  "sweep.lua": ["height", SWEEP],
  "gold.lua": ["roughness", `local glint = require "glint"
local P = glint.params { roughness = { 0.3, min = 0.05, max = 0.9 } }
local gold = glint.material { model = "cook_torrance", f0 = { 1, 0.77, 0.34 }, diffuse = 0, roughness = P.roughness }
return glint.animation { frames = 1, width = 640, height = 400, scene = glint.scene {
  camera = glint.camera { eye = { 0, 1, 8 }, at = { 0, 0, 0 } }, background = { 0.3, 0.4, 0.6 }, ambient = 0.1,
  glint.point_light { position = { 5, 8, 5 } }, glint.sphere { center = { 0, 0, 0 }, radius = 2, material = gold },
  glint.label { text = [[$\\alpha$ of GGX]], at = { 0.5, 0 } } } }`],
}

// Moves the slider of a figure through 40 steps with the mouse. Returns the pictures shown before it rests.
async function dragged(page, one, param) {
  await one.evaluate(figure => {
    figure.found = []
    figure.addEventListener("glint-render", ({ detail: { image, coarse, ms } }) => {
      const letters = [...figure.shadowRoot.querySelectorAll(".over text")].map(text => parseFloat(getComputedStyle(text).fontSize))
      figure.found.push({ width: image.width, height: image.height, samples: image.samples, ownSamples: image.ownSamples, casts: image.casts, coarse, ms, letters })
    })
  })
  const slider = one.locator(`input[type=range][data-name=${param}], input[type=range]:not(.frames)`).first()
  await slider.scrollIntoViewIfNeeded()
  const box = await slider.boundingBox(), y = box.y + box.height / 2
  await page.mouse.move(box.x + 9, y)
  await page.mouse.down()
  for (let i = 0; i <= 40; i++) {
    await page.mouse.move(box.x + 9 + (box.width - 18) * i / 40, y)
    await page.waitForTimeout(20)
    if (i === 30) await page.screenshot({ path: join(work, `drag-${param}-${page.viewportSize().width}.png`) })
  }
  await page.mouse.up()
  await page.waitForFunction(figure => figure.found.length > 0 && !figure.found.at(-1).coarse, await one.elementHandle())
  return one.evaluate(figure => figure.found)
}

async function dragging() {
  for (const [name, [param, script]] of Object.entries(FIGURES)) {
    writeFileSync(join(work, name), script)
    for (const [viewport, density] of [[{ width: 1280, height: 800 }, 1], [{ width: 390, height: 844 }, 2]]) {
      writeFileSync(join(web, "dragging.html"), `<!doctype html><meta name="viewport" content="width=device-width"><link rel="icon" href="data:,">
        <script type="module" src="glint-figure.js"></script><glint-figure><script type="text/x-lua" name="${name}">${script}</script></glint-figure>`)
      const page = await open(`${base}/dragging.html`, viewport, density), one = page.locator("glint-figure"), what = `${name} on a page of ${viewport.width} pixels`
      await page.waitForFunction(() => document.querySelector("glint-figure").isFull) // it may be full already
      const shown = await one.locator(".picture").boundingBox(), found = await dragged(page, one, param)
      const moving = found.filter(picture => picture.coarse && picture.ownSamples === 1), last = found.at(-1)
      const sizes = [...new Set(moving.map(picture => `${picture.width}x${picture.height}`))], times = moving.map(picture => Math.round(picture.ms)).sort((a, b) => a - b)
      console.log(`${what}: ${moving.length} pictures of ${sizes.join(", ")}, median ${times[times.length >> 1]} ms`)
      check(moving.length > 4, `${what}: ${moving.length} pictures while the slider moves`)
      check(Math.abs(last.width - shown.width * density) <= 1 && last.samples >= 4, `${what}: at rest ${last.width} pixels, ${last.samples} samples`)
      check(found.every(picture => picture.letters.every(size => size >= 12)), `${what}: letters of ${Math.min(...found.flatMap(picture => picture.letters))} pixels`)
      const blanks = await one.evaluate(figure => [...figure.shadowRoot.querySelectorAll(".over text")].every(text => text.getNumberOfChars() === text.textContent.length))
      check(blanks, `${what}: blanks beside formulas`)
      check(name !== "vectors.lua" || moving.slice(-3).every(picture => picture.casts === 0), `${what}: a changed material casts again`)
      const value = await one.evaluate((figure, key) => figure.values[key], param)
      run(bare(name, work), "--size", `${last.width}x${last.height}`, ...AT_REST, "--set", `${param}=${value}`, "-f", "1", "--force", "--quiet", "-o", "dragged_####.png")
      check(same(await codesShown(one), await codesOf(page, join(work, "dragged_0001.png"))), `${what}: the bits of the command's picture`)
      await page.screenshot({ path: join(work, `rest-${param}-${viewport.width}.png`) })
      await close(page, what)
    }
  }
  rmSync(join(web, "dragging.html"))
}

for (const test of [playground, sharing, figure, course, published, live, steps, dragging, phone]) {
  if (!test.name.includes(process.env.T ?? "")) continue
  try {
    await test()
  } catch (error) {
    check(false, `${test.name}: ${error.message}`)
  }
}
await browser.close()
server.close()
console.log(`${passed} passed, ${failed} failed`)
process.exit(failed === 0 ? 0 : 1)
