// Tests what a reader of a page with figures sees: still pictures, formulas, letters on a phone, the order of controls, lines
// and messages. element.sh runs this file.
import { execFileSync } from "node:child_process"
import { writeFileSync } from "node:fs"
import { join } from "node:path"
import { browser, check, close, DESK, figureOf, glint, open, PHONE, ready, run, runAll, settled, web, work, write } from "./browser.mjs"

const publish = (script, page) => execFileSync(glint, ["publish", script, "-o", page], { cwd: work, stdio: "pipe", env: { ...process.env, GLINT_FONT: "", GLINT_WEB: web } })

// Returns the letters in sight over a figure's picture, as [text, font size on the page, x, y], in CSS pixels.
const lettersOf = page => page.evaluate(() => {
  const figure = document.querySelector("glint-figure")
  const all = [...figure.querySelectorAll(":scope > svg text"), ...figure.shadowRoot?.querySelectorAll(".over text") ?? []]
  return all.map(text => ({ text, box: text.getBoundingClientRect() })).filter(({ box }) => box.width > 0).map(({ text, box }) =>
    [text.textContent, text.getAttribute("font-size") * box.height / text.getBBox().height, box.x, box.y].map(one => typeof one === "number" ? Number(one.toFixed(1)) : one))
})

writeFileSync(join(work, "labels.lua"), `local glint = require "glint"
local P = glint.params { ks = { 0.5, min = 0, max = 1, label = "$k_s$", doc = "exponent $x^n$ of $k$" } }
return glint.animation { frames = 1, width = 640, height = 400, scene = glint.scene { camera = glint.camera { eye = { 0, 0, 7 }, at = { 0, 0, 0 } },
  ambient = 0.4, background = "white", glint.sphere { center = { 0, 0, 0 }, radius = 1.3, material = glint.material { specular = P.ks } },
  glint.label { text = [[$L_o = k_a L_a + \\sum_i L_i\\left(k_d\\,(\\hat n\\cdot\\hat l_i) + k_s\\,(\\hat r_i\\cdot\\hat v)^n\\right)$]], at = "top", color = "black", size = 18 },
  glint.label { text = "a caption without a size", at = "bottom left", color = "black" } } }`)

// The still picture of a published page has the letters of the live one, and at least four samples.
async function still() {
  publish("labels.lua", "still.html")
  const address = `file://${join(work, "still.html")}`
  for (const [name, options] of [["desk", DESK], ["phone", PHONE]]) {
    const context = await browser.newContext({ ...options, javaScriptEnabled: false }), plain = await context.newPage()
    await plain.goto(address)
    check(await plain.locator("glint-figure > svg:visible").count() === 1, `still, ${name}: overlays without JavaScript`)
    check(await plain.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `still, ${name}: no horizontal scroll`)
    const image = await plain.locator("glint-figure > img").boundingBox(), marks = await plain.locator("glint-figure > svg:visible").boundingBox()
    check(["x", "y", "width", "height"].every(side => Math.abs(image[side] - marks[side]) < 1), `still, ${name}: the overlays lie over the picture`)
    await plain.screenshot({ path: join(work, `still-${name}.png`) })
    await context.close()
    const page = await open("about:blank", options)
    await page.goto(address, { waitUntil: "commit" })
    await page.waitForFunction(() => document.querySelectorAll("glint-figure > svg").length === 2)
    const before = await lettersOf(page)
    await ready(figureOf(page))
    await settled(figureOf(page))
    const after = await lettersOf(page)
    check(before.length > 20 && before.every(([, size]) => size >= 12), `still, ${name}: letters of ${Math.min(...before.map(one => one[1]))}`)
    check(JSON.stringify(before) === JSON.stringify(after), `still, ${name}: letters jump:\n${before}\n${after}`)
    check(after.every(([,, x]) => x >= 0 && x < options.viewport.width), `still, ${name}: letters outside`)
    // an edge of one sample has no values between the ball and the white ground
    const shades = await page.evaluate(async () => {
      const image = document.querySelector("glint-figure > img"), canvas = new OffscreenCanvas(image.naturalWidth, image.naturalHeight), context = canvas.getContext("2d")
      context.drawImage(image, 0, 0)
      const row = context.getImageData(0, 200, canvas.width, 1).data, seen = [...row].filter((_, i) => i % 4 === 0)
      return seen.slice(0, 320).filter((one, i) => one < 255 && seen[i - 1] === 255 && seen[i + 1] < one).length
    })
    check(shades >= 1, `still, ${name}: stairs at edges`)
    await close(page, `still, ${name}`)
  }
}

// Without a font for mathematics, browsers set subscripts on the baseline.
async function formulas() {
  write("formulas.html", `<glint-figure src="labels.lua"></glint-figure>`)
  const page = await open("formulas.html"), figure = figureOf(page)
  await ready(figure)
  const box = locator => figure.locator(locator).evaluate(one => one.getBoundingClientRect().toJSON())
  const base = await box(".name msub > mi"), down = await box(".name msub mpadded mi, .name msub mi:nth-child(2)")
  check(down.bottom > base.bottom + 1.5 && down.top > base.top && down.height < base.height, `formulas: a subscript: ${base.bottom} ${down.bottom}`)
  const x = await box(".doc msup > mi"), up = await box(".doc msup mpadded mi, .doc msup mi:nth-child(2)"), size = parseFloat(await figure.locator(".doc").evaluate(one => getComputedStyle(one).fontSize))
  check(up.bottom < x.bottom - 0.2 * size && up.bottom > x.top - 0.2 * size, `formulas: an exponent: ${x.top} ${x.bottom} ${up.bottom}`)
  await page.screenshot({ path: join(work, "formulas.png"), fullPage: true })
  await close(page, "formulas")
}

writeFileSync(join(work, "order.lua"), `local glint = require "glint"
-- alpha = of the comment
local P = glint.params {
  n = { 5, min = 1, max = 50 }, ["ks"] = { 0.5, min = 0, max = 1 }, -- mode = a comment
  angle = { 30, min = 0, max = 90 }, N = { 2, min = 1, max = 9, whole = true }, alpha = true,
  lamp = { { 1, 2, 3 }, drag = true, unit = "m" }, mode = { "a", choices = { "a", "b" } },
}
return glint.animation { frames = 1, width = 320, height = 200, samples = 16, scene = glint.scene { camera = glint.camera { eye = { 0, 0, 7 }, at = { 0, 0, 0 } },
  glint.sphere_light { position = P.lamp, radius = 0.5, samples = 4 }, glint.sphere { center = { 0, 0, 0 }, radius = P.N / 2, material = glint.material { shininess = P.n } } } }`)

// Controls stand in the script's order; n and N have values of their own; a double click on a handle returns to the default.
async function controls() {
  publish("order.lua", "order.html")
  for (const address of ["order.html", "order-src.html"]) {
    if (address === "order-src.html") write(address, `<glint-figure src="order.lua" width="320"></glint-figure>`)
    const page = await open(address), figure = figureOf(page)
    const names = () => figure.locator(".name").allInnerTexts().then(all => all.join())
    if (address === "order.html") {
      await figure.locator(".control").first().waitFor({ state: "visible" })
      check(await names() === "n,ks,angle,N,alpha,lamp,mode", `controls, ${address}: before the engine: ${await names()}`)
    }
    await ready(figure)
    check(await names() === "n,ks,angle,N,alpha,lamp,mode", `controls, ${address}: ${await names()}`)
    if (address === "order-src.html") {
      check(await figure.locator(".control").filter({ hasText: "lamp" }).locator(".value").innerText() === "m", "controls: the unit of a point")
      await figure.getByLabel("N", { exact: true }).focus()
      await page.keyboard.press("End")
      const values = () => figure.evaluate(one => JSON.stringify(one.values))
      check(await values() === '{"N":9}' && await figure.getAttribute("n") === null, `controls: N: ${await values()} ${await figure.getAttribute("n")}`)
      await figure.evaluate(one => one.setAttribute("n", 7))
      check(await values() === '{"N":9,"n":7}', `controls: n: ${await values()}`)
      await figure.getByLabel("lamp x").fill("2")
      await settled(figure)
      await figure.locator(".handle").dblclick()
      check(JSON.parse(await values()).lamp.join() === "1,2,3" && await figure.getByLabel("lamp x").inputValue() === "1", `controls: a double click on a handle: ${await values()}`)
    }
    await close(page, `controls, ${address}`)
  }
}

// Links with wrong values, sizes in per cent, scripts that never end and scripts with faults.
async function messages() {
  write("link.html", `<div style="width: 500px"><glint-figure src="order.lua" width="50%"></glint-figure></div>`)
  const page = await open("link.html#n=7&lamp=a,b,c&N=100&mode=c"), figure = figureOf(page)
  await ready(figure)
  await settled(figure)
  const box = await figure.locator("canvas").boundingBox()
  check(Math.abs(box.width - 250) < 1 && Math.abs(box.height - 250 * 200 / 320) < 1, `messages: half of 500 pixels: ${box.width} x ${box.height}`)
  const text = await figure.locator(".error").innerText()
  check(text === "The link has N = 100; expected a whole number from 1 to 9\nThe link has lamp = a,b,c; expected three numbers X,Y,Z\nThe link has mode = c; expected one of a, b", `messages: ${text}`)
  check(JSON.stringify(await figure.evaluate(one => one.values)) === '{"n":7}' && await figure.getByLabel("mode").inputValue() === "a", "messages: the other values hold")
  check(await figure.locator(".timing").innerText() === "", "messages: a finished picture has no line")
  await figure.getByRole("button", { name: "Reset" }).click()
  await settled(figure)
  check(await figure.locator(".error").isHidden(), "messages: Reset")
  await close(page, "messages")

  writeFileSync(join(work, "endless.lua"), "while true do end")
  writeFileSync(join(work, "fault.lua"), "error 'no such ball'")
  write("faults.html", `<glint-figure src="endless.lua" width="320"></glint-figure><glint-figure src="fault.lua" width="320" height="200"></glint-figure>`)
  const since = Date.now(), wrong = await open("faults.html"), [endless, fault] = [figureOf(wrong, 0), figureOf(wrong, 1)]
  await fault.locator(".error").waitFor({ state: "visible" })
  check((await fault.boundingBox()).height < 150, `messages: a failed figure keeps ${(await fault.boundingBox()).height} pixels`)
  await wrong.waitForTimeout(1500)
  check(await endless.locator(".wait").evaluate(one => one.checkVisibility() && one.getBoundingClientRect().height > 2 && one.getAnimations().length > 0), "messages: a line while a script runs")
  await endless.locator(".error").waitFor({ state: "visible" })
  check((await endless.locator(".error").innerText()).includes("the script took longer than 10") && Date.now() - since < 20000, `messages: endless: ${await endless.locator(".error").innerText()}`)
  check(await endless.locator(".wait").isHidden(), "messages: no line after a message")
  await close(wrong, "faults")
}

// A contact sheet as a page sets the formulas of its title, its axes and its values.
async function sheet() {
  writeFileSync(join(work, "axes.lua"), `local glint = require "glint"
local ball = glint.sphere { center = { 0, 0, 0 }, radius = 1 }
return glint.sweep { size = { 64, 48 }, scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, ambient = 1, ball },
  over = { { ball.material, "shininess", { 4, 16 } }, { ball.material, "model", { "phong", "blinn_phong" } } },
  sheet = { output = "axes.html", title = [[Highlights $k_s (\\hat r \\cdot \\hat v)^n < \\sqrt{2}$ for $5 </script>]], names = { shininess = "exponent $n$", phong = [[$\\hat r$]] } } }`)
  run("axes.lua", "-o", "axes.png")
  const page = await open("about:blank")
  await page.goto(`file://${join(work, "axes.html")}`)
  const heading = page.locator("h1")
  check((await heading.innerText()).endsWith("for $5 </script>") && await heading.locator("msqrt").count() === 1 && await heading.locator("mover").count() === 2, `sheet: ${await heading.innerText()}`)
  check(await page.locator("form label math").count() === 1 && await page.locator("th math").count() === 2 && await page.locator("form output math").count() === 1, "sheet: axes and values")
  check(!/[$\\]/.test(await page.locator("form").innerText()), `sheet: ${await page.locator("form").innerText()}`)
  await close(page, "sheet")
}

await runAll([still, formulas, controls, messages, sheet])
