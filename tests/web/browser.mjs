// The tests of live figures in headless Chromium: a server, pages of figures, and comparison with the pictures of the command.
//   node TEST.mjs WEB GLINT SCRIPTS WORK
// The arguments are those of pages.mjs.
import { execFileSync } from "node:child_process"
import { createServer } from "node:http"
import { cpSync, createReadStream, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs"
import { dirname, extname, join, normalize } from "node:path"
import { fileURLToPath } from "node:url"
import { chromium } from "playwright-core"

export const [web, glint, scripts, work] = process.argv.slice(2)
const LIMIT_MS = 60000
rmSync(work, { recursive: true, force: true })
mkdirSync(work, { recursive: true })
writeFileSync(join(work, "lamp.lua"), readFileSync(join(scripts, "../tests/web/lamp.lua")))

let passed = 0, failed = 0
export function check(holds, what) {
  if (holds) passed++
  else failed++
  if (!holds) console.log(`failed: ${what}`)
}

// ---- A server of the folder, and Chromium ----

const types = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".png": "image/png" }
const server = createServer((request, response) => {
  const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname))
  const file = [join(work, path), join(web, path)].find(one => existsSync(one))
  response.writeHead(file ? 200 : 404, { "content-type": types[extname(file ?? "")] ?? "text/plain" })
  if (file) createReadStream(file).pipe(response)
  else response.end()
})
await new Promise(done => server.listen(0, "127.0.0.1", done))
export const base = `http://127.0.0.1:${server.address().port}`
export const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"] })

export const DESK = { viewport: { width: 1280, height: 800 } }
export const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 }

export async function open(address, options = DESK) {
  const context = await browser.newContext(options)
  const page = await context.newPage()
  page.setDefaultTimeout(LIMIT_MS)
  page.messages = []
  page.on("console", message => message.text().includes("willReadFrequently") || page.messages.push(`${message.type()}: ${message.text()}`))
  page.on("pageerror", error => page.messages.push(`error: ${error.message}`))
  await page.goto(address.includes(":") ? address : `${base}/${address}`)
  return page
}

export async function close(page, what) {
  check(page.messages.length === 0, `${what}: the console has: ${page.messages.join(" | ")}`)
  await page.context().close()
}

export function write(name, body) {
  writeFileSync(join(work, name), `<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Test</title><link rel="icon" href="data:,"><script type="module" src="glint-figure.js"></script>${body}</html>`)
}

// ---- Figures ----

export const figureOf = (page, i = 0) => page.locator("glint-figure").nth(i)
export const ready = figure => figure.locator("canvas").waitFor({ state: "visible" })
export const settled = figure => figure.evaluate(one => new Promise((resolve, reject) => {
  let timer = setTimeout(resolve, 700)
  one.addEventListener("glint-render", ({ detail }) => {
    clearTimeout(timer)
    timer = setTimeout(resolve, detail.coarse ? 5000 : 700)
  })
  setTimeout(() => reject(new Error("no full picture")), 60000)
}))

// Returns whether the figure's job gives the command's picture for the values that the figure has.
export async function same(page, figure, ...words) {
  const script = words[0]?.endsWith(".lua") ? words.shift() : "lamp.lua"
  await settled(figure)
  const codes = await figure.evaluate(async one => {
    const { set, frame, orbit } = one.request()
    const image = await one.job.render({ set, frame, ...orbit && { orbit }, width: 64, height: 40, samples: 1 })
    return [...image.rgba]
  })
  execFileSync(glint, [script, "--size", "64x40", "--samples", "1", "--force", "--quiet", "-o", "native.png", ...words], { cwd: work, env: { ...process.env, GLINT_FONT: "bitmap" } })
  const native = await page.evaluate(async base64 => {
    const picture = new Image()
    picture.src = `data:image/png;base64,${base64}`
    await picture.decode()
    const canvas = Object.assign(document.createElement("canvas"), { width: picture.naturalWidth, height: picture.naturalHeight })
    canvas.getContext("2d").drawImage(picture, 0, 0)
    return [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data]
  }, readFileSync(join(work, "native.png")).toString("base64"))
  return codes.length === native.length && codes.every((code, i) => code === native[i])
}

export const valuesOf = figure => figure.evaluate(one => one.values)
export const eventsOf = figure => figure.evaluate(one => one.events)
export const listen = figure => figure.evaluate(one => {
  one.events = []
  one.addEventListener("value", ({ detail }) => one.events.push(detail))
})

export const run = (...words) => execFileSync(glint, words, { cwd: work, stdio: "pipe", env: { ...process.env, GLINT_FONT: "bitmap", GLINT_WEB: web, LUA_PATH: "./?.lua" } })

// Returns how far the layout of a page has shifted since it began to load, as browsers count it.
export const shiftOf = page => page.evaluate(() => new Promise(resolve => {
  let sum = 0
  new PerformanceObserver(list => { for (const one of list.getEntries()) sum += one.value }).observe({ type: "layout-shift", buffered: true })
  setTimeout(() => resolve(sum), 200)
}))

// Sends touches at points of the page through the browser's own input.
export async function touches(page) {
  const session = await page.context().newCDPSession(page)
  return (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) })
}

// Runs the tests whose name contains the variable T, and ends the program.
export async function runAll(tests) {
  for (const test of tests.filter(one => one.name.includes(process.env.T ?? ""))) {
    try {
      await test()
    } catch (error) {
      check(false, `${test.name}: ${error.stack}`)
    }
  }
  await browser.close()
  server.close()
  console.log(`${passed} passed, ${failed} failed`)
  process.exit(failed === 0 ? 0 : 1)
}
