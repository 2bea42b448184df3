// Tests the element <glint-figure> as a reader uses it, with mouse, keyboard and fingers: controls, points, views, links,
// attributes, events, errors, pages on a disk and published pages. Pictures equal the command's. element.sh runs this file.
import { execFileSync } from "node:child_process"
import { cpSync, readFileSync, writeFileSync } from "node:fs"
import { dirname, join } from "node:path"
import { fileURLToPath } from "node:url"
import {
  web, glint, scripts, work, browser, DESK, PHONE, check, open, close, write, figureOf, ready, settled, same, valuesOf, eventsOf, listen, run, shiftOf, touches, runAll,
} from "./browser.mjs"

async function controls() {
  write("controls.html", `<glint-figure src="lamp.lua" width="640" height="400"></glint-figure>`)
  const page = await open("controls.html"), figure = figureOf(page)
  await ready(figure)
  await listen(figure)
  const text = await figure.locator("form").innerText()
  for (const wanted of ["position of the lamp", "angle of the plate", "20\u202f°", "1\u202fm", "256", "90"]) check(text.includes(wanted), `controls: the text has ${wanted}`)
  check(await figure.locator(".name math mi").first().textContent() === "n", "controls: a label has a formula")
  check(await figure.locator(".doc math msup").count() === 1 && await figure.locator(".doc math mover").count() === 2, "controls: a doc has a formula")
  check(await figure.getByLabel("model").locator("option").allInnerTexts().then(all => all.join()) === "phong,Blinn-Phong", "controls: names of choices")

  const slider = figure.getByLabel("tilt")
  await slider.focus()
  await page.keyboard.press("ArrowRight")
  check((await valuesOf(figure)).tilt === 21, `controls: an arrow key: ${JSON.stringify(await valuesOf(figure))}`)
  await figure.getByLabel("height").focus()
  await page.keyboard.press("ArrowLeft")
  check((await valuesOf(figure)).height === 0.985, `controls: an arrow key of a fine slider: ${JSON.stringify(await valuesOf(figure))}`)
  await page.keyboard.press("End")
  await figure.getByLabel("model").selectOption("blinn_phong")
  await figure.getByLabel("Lamp x").fill("-2")
  await figure.getByLabel("floor").uncheck()
  check(await same(page, figure, "--set", "tilt=21", "--set", "height=2", "--set", "model=blinn_phong", "--set", "lamp=-2,2,2", "--set", "floor=false"), "controls: the picture has their values")
  check((await eventsOf(figure)).some(one => one.name === "model" && one.value === "blinn_phong" && !one.moving), "controls: events")
  check(await figure.getAttribute("tilt") === "21" && await figure.getAttribute("set-height") === "2" && await figure.getAttribute("lamp") === "-2,2,2", "controls: attributes follow")
  await slider.dblclick()
  check((await valuesOf(figure)).tilt === 20, "controls: a double click returns to the default")
  await figure.getByRole("button", { name: "Reset" }).click()
  check(await same(page, figure), "controls: Reset returns to the defaults")
  check(await figure.getAttribute("lamp") === null, "controls: Reset removes attributes")
  await page.screenshot({ path: join(work, "controls.png"), fullPage: true })
  await close(page, "controls")
}

async function attributes() {
  write("attributes.html", `<glint-figure id="a" src="lamp.lua" shininess="8" lamp="-1,4,2" set-height="1.5" width="320"></glint-figure>
<glint-figure id="b" src="lamp.lua" controls="tilt" width="320"></glint-figure>`)
  let loads = 0
  const page = await open("attributes.html")
  page.on("request", request => { loads += request.url().endsWith(".wasm") })
  const [a, b] = [figureOf(page, 0), figureOf(page, 1)]
  await Promise.all([ready(a), ready(b)])
  check(await same(page, a, "--set", "shininess=8", "--set", "lamp=-1,4,2", "--set", "height=1.5"), "attributes: values at the start")
  await a.evaluate(one => one.setAttribute("shininess", "100"))
  await a.evaluate(one => one.setAttribute("model", "blinn_phong"))
  check(await same(page, a, "--set", "shininess=100", "--set", "lamp=-1,4,2", "--set", "height=1.5", "--set", "model=blinn_phong"), "attributes: changed values")
  check(await a.locator("input[type=range]").evaluateAll(all => all.some(one => one.getAttribute("aria-valuetext") === "100")), "attributes: the control follows")
  await b.evaluate(one => one.set({ lamp: [0, 5, 1], tilt: 45 }))
  check(await same(page, b, "--set", "lamp=0,5,1", "--set", "tilt=45"), "attributes: set()")
  check(await b.locator(".control").count() === 1, "attributes: controls")
  await a.evaluate(one => one.setAttribute("shininess", "many"))
  await a.locator(".error").waitFor({ state: "visible" })
  check((await a.locator(".error").innerText()).includes("--set shininess: number 1 .. 256 expected, got 'many'"), "attributes: an error is shown")
  await a.evaluate(one => one.removeAttribute("shininess"))
  check(await same(page, a, "--set", "lamp=-1,4,2", "--set", "height=1.5", "--set", "model=blinn_phong"), "attributes: without the value, the default")
  check(await a.locator(".error").isHidden(), "attributes: the error is gone")
  check(loads <= 1, `attributes: the module was loaded ${loads} times`)
  await close(page, "attributes")
}

async function errors() {
  writeFileSync(join(work, "wrong.lua"), 'local glint = require "glint"\n\nlocal red = glint.material { shininess = -1 }\n')
  write("errors.html", `<glint-figure src="wrong.lua"></glint-figure><glint-figure src="missing.lua"></glint-figure>`)
  const page = await open("errors.html")
  for (const i of [0, 1]) await figureOf(page, i).locator(".error").waitFor({ state: "visible" })
  const [wrong, missing] = [await figureOf(page, 0).locator(".error").innerText(), await figureOf(page, 1).locator(".error").innerText()]
  check(wrong.includes("wrong.lua:3: material.shininess") && wrong.includes("3 | local red"), `errors: ${wrong}`)
  check(missing.includes("missing.lua: the server answers 404"), `errors: ${missing}`)
  await page.context().close()
}

// ---- The picture as a control ----

const boxOf = async locator => (await locator.boundingBox())
const middleOf = box => [box.x + box.width / 2, box.y + box.height / 2]

async function hands() {
  write("hands.html", `<glint-figure src="lamp.lua" width="640" height="400"></glint-figure>`)
  const page = await open("hands.html"), figure = figureOf(page)
  await ready(figure)
  await listen(figure)
  await settled(figure)
  const handle = figure.locator(".handle"), picture = await boxOf(figure.locator(".hands"))
  const [x, y] = middleOf(await boxOf(handle))
  // the lamp by hand: 9 units away from the eye, seen along the line to (0, 0.5, 0)
  const ahead = [0, -1.5, -9].map(c => c / Math.hypot(1.5, 9)), up = [0, 9, -1.5].map(c => c / Math.hypot(1.5, 9)), to = [1.5, 0, -7]
  const depth = to.reduce((sum, c, i) => sum + c * ahead[i], 0), high = to.reduce((sum, c, i) => sum + c * up[i], 0)
  const unit = picture.height / 2 / Math.tan(35 / 2 * Math.PI / 180) / depth // pixels
  check(Math.abs(x - picture.x - 320 - 1.5 * unit) < 1 && Math.abs(y - picture.y - 200 + high * unit) < 1, `hands: the handle is at ${x - picture.x}, ${y - picture.y}`)
  await page.mouse.move(x, y)
  await page.mouse.down()
  for (let i = 1; i <= 10; i++) await page.mouse.move(x - 15 * i, y + 5 * i)
  await page.mouse.up()
  const { lamp } = await valuesOf(figure)
  const expected = [1.5 - 150 / unit, 2 - 50 / unit * up[1], 2 - 50 / unit * up[2]]
  check(lamp.every((c, i) => Math.abs(c - expected[i]) < 0.01), `hands: the lamp is at ${lamp}, expected ${expected}`)
  check(await same(page, figure, "--set", `lamp=${lamp}`), "hands: the picture of the moved lamp")
  const after = middleOf(await boxOf(handle))
  check(Math.hypot(after[0] - x + 150, after[1] - y - 50) < 1.5, "hands: the handle follows")
  check((await figure.getByLabel("Lamp x").inputValue()) === String(lamp[0]), "hands: the fields follow")
  const events = await eventsOf(figure)
  check(events.length > 2 && events[0].moving && !events.at(-1).moving && events.every(one => one.name === "lamp"), "hands: events")
  await handle.focus()
  await page.keyboard.press("ArrowRight")
  const moved = (await valuesOf(figure)).lamp
  check(moved[0] > lamp[0] && Math.abs(moved[0] - lamp[0] - 6.4 / unit) < 0.01, "hands: an arrow key moves the lamp")
  await figure.getByRole("button", { name: "Reset" }).click()

  // the view: half a picture to the left turns it by 90 degrees to the right
  await page.mouse.move(picture.x + 500, picture.y + 300)
  await page.mouse.down()
  for (let i = 1; i <= 8; i++) await page.mouse.move(picture.x + 500 - 40 * i, picture.y + 300 + 5 * i)
  await page.mouse.up()
  const orbit = await figure.evaluate(one => one.request().orbit)
  check(orbit && orbit[0] === 90 && orbit[1] === 18, `hands: a drag turns the view: ${orbit}`)
  check(await same(page, figure, "--orbit", orbit.join(",")), "hands: the picture of the turned view")
  await figure.locator(".hands").focus()
  await page.keyboard.press("ArrowLeft")
  await page.keyboard.press("+")
  const keyed = await figure.evaluate(one => one.request().orbit)
  check(keyed[0] === 85 && keyed[2] === 1.1, `hands: keys turn and zoom: ${keyed}`)
  await page.screenshot({ path: join(work, "hands.png") })

  // a link has the values and the view
  await figure.getByLabel("tilt").focus()
  await page.keyboard.press("End")
  await figure.getByRole("button", { name: "Copy link" }).click()
  await page.waitForFunction(() => location.hash.length > 1)
  const other = await open(page.url()), copy = figureOf(other)
  await ready(copy)
  check(await same(other, copy, "--set", "tilt=90", "--orbit", keyed.join(",")), `hands: the link ${page.url()}`)
  await other.evaluate(() => { location.hash = "#shininess=5" })
  check(await same(other, copy, "--set", "tilt=90", "--set", "shininess=5", "--orbit", keyed.join(",")), "hands: a changed address")
  await close(other, "hands: link")
  await figure.locator(".hands").dblclick({ position: { x: 20, y: 20 } })
  check(await figure.evaluate(one => one.request().orbit) === undefined, "hands: a double click returns to the view of the script")
  await close(page, "hands")
}

async function phone() {
  write("phone.html", `<p>Text before.</p><glint-figure src="lamp.lua" width="640" height="400"></glint-figure><div style="height: 1500px">Text after.</div>`)
  const page = await open("phone.html", PHONE), figure = figureOf(page)
  await ready(figure)
  await settled(figure)
  check(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "phone: no horizontal scroll")
  const small = await figure.evaluate(one => [...one.shadowRoot.querySelectorAll("button, input, select")].filter(part => part.checkVisibility())
    .map(part => ({ name: part.className || part.type, ...part.getBoundingClientRect().toJSON() })).filter(box => box.height < 44 || box.width < 44).map(box => `${box.name} ${box.width}x${box.height}`))
  check(small.length === 0, `phone: small targets: ${small}`)
  const letters = await figure.evaluate(one => [...one.shadowRoot.querySelectorAll(".name, .value, .end, .doc, .timing")].map(part => parseFloat(getComputedStyle(part).fontSize)))
  check(letters.every(size => size >= 12), `phone: letters of ${Math.min(...letters)} pixels`)
  await page.screenshot({ path: join(work, "phone.png"), fullPage: true })

  const touch = await touches(page), box = await boxOf(figure.locator(".hands"))
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height]
  await touch("touchStart", at(0.3, 0.8))
  for (let i = 1; i <= 10; i++) await touch("touchMove", at(0.3 + 0.03 * i, 0.8))
  await touch("touchEnd")
  const turned = await figure.evaluate(one => one.request().orbit)
  check(turned && Math.abs(turned[0] + 54) < 4, `phone: a finger turns the view: ${turned}`)
  check(await page.evaluate(() => scrollY) === 0, "phone: the page stands while the view turns")
  await touch("touchStart", at(0.4, 0.5), at(0.6, 0.5))
  for (let i = 1; i <= 10; i++) await touch("touchMove", at(0.4 - 0.02 * i, 0.5 - 0.01 * i), at(0.6 + 0.02 * i, 0.5 - 0.01 * i))
  await touch("touchEnd")
  const pinched = await figure.evaluate(one => one.request().orbit)
  check(Math.abs(pinched[2] - 3) < 0.2 && Math.abs(pinched[4] - 0.1) < 0.03 && Math.abs(pinched[3]) < 0.02, `phone: two fingers zoom and shift: ${pinched}`)
  await figure.getByRole("button", { name: "Reset" }).tap()
  await page.evaluate(() => scrollTo(0, 0))
  await settled(figure)
  const before = middleOf(await boxOf(figure.locator(".handle")))
  await touch("touchStart", before)
  for (let i = 1; i <= 5; i++) await touch("touchMove", [before[0] - 8 * i, before[1] + 4 * i])
  await touch("touchEnd")
  check((await valuesOf(figure)).lamp?.[0] < 1.4, `phone: a finger moves the lamp: ${JSON.stringify(await valuesOf(figure))}`)
  check(await figure.evaluate(one => one.request().orbit) === undefined, "phone: the view stands while the lamp moves")
  await touch("touchStart", at(0.5, 0.9))
  for (let i = 1; i <= 10; i++) await touch("touchMove", [at(0.5, 0.9)[0], at(0.5, 0.9)[1] - 15 * i])
  await touch("touchEnd")
  await page.waitForTimeout(300)
  check(await page.evaluate(() => scrollY) > 50, "phone: a vertical finger scrolls the page")
  check(await figure.evaluate(one => one.request().orbit) === undefined, "phone: the view stands while the page scrolls")
  await close(page, "phone")
}

// ---- Pages ----

async function published() {
  run("publish", "lamp.lua", "-o", "moving_lamp.html", "--set", "tilt=30")
  run("publish", "lamp.lua", "-o", "titled.html", "--title", "Exponent $n^2$")
  const titled = await open(`file://${join(work, "titled.html")}`)
  check(await titled.locator("h1 math msup").count() === 1 && (await titled.title()) === "Exponent $n^2$", "published: a heading has a formula")
  await close(titled, "published: title")
  for (const [name, options] of [["desk", DESK], ["phone", PHONE]]) {
    const page = await open(`file://${join(work, "moving_lamp.html")}`, options), figure = figureOf(page)
    await figure.locator(".control").first().waitFor({ state: "visible" })
    const top = await page.evaluate(() => document.querySelector("glint-figure").getBoundingClientRect().bottom)
    await ready(figure)
    await settled(figure)
    check(Math.abs(await page.evaluate(() => document.querySelector("glint-figure").getBoundingClientRect().bottom) - top) < 1, `published, ${name}: the layout stands`)
    check(await page.locator("h1").innerText() === "Lamp" || await page.title() === "Lamp", `published, ${name}: a heading`)
    check(await same(page, figure, "--set", "tilt=30"), `published, ${name}: the picture`)
    check(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `published, ${name}: no horizontal scroll`)
    await page.screenshot({ path: join(work, `published-${name}.png`), fullPage: true })
    await close(page, `published, ${name}`)
  }
  // other pages show a published page: as an element with its own attributes, and as a frame with values in its address
  write("embedding.html", `<glint-figure src="moving_lamp.html" shininess="4" controls="shininess,tilt"></glint-figure>
<iframe src="moving_lamp.html#shininess=64&orbit=20,10" width="700" height="700" title="A lamp"></iframe>`)
  const page = await open("embedding.html"), figure = figureOf(page)
  await ready(figure)
  check(await same(page, figure, "--set", "tilt=30", "--set", "shininess=4"), "embedding: an element with a published page")
  const inner = page.frameLocator("iframe").locator("glint-figure")
  await inner.locator("canvas").waitFor({ state: "visible" })
  check(await same(page, inner, "--set", "tilt=30", "--set", "shininess=64", "--orbit", "20,10"), "embedding: a frame")
  await close(page, "embedding")
  const context = await browser.newContext({ javaScriptEnabled: false, ...DESK }), still = await context.newPage()
  await still.goto(`file://${join(work, "moving_lamp.html")}`)
  check(await still.locator("glint-figure img").isVisible(), "published: a picture without JavaScript")
  await context.close()
  const narrow = await browser.newContext({ javaScriptEnabled: false, viewport: { width: 390, height: 844 } }), phone = await narrow.newPage()
  await phone.goto(`file://${join(work, "moving_lamp.html")}`)
  const right = await phone.locator("glint-figure img").evaluate(one => one.getBoundingClientRect().right)
  check(right <= 390, `published: without JavaScript, the picture fits a phone: ${right}`)
  await narrow.close()
}

// The example of the recipes: its script and its page.
async function recipe() {
  const text = readFileSync(join(scripts, "../bindings/docs/how-to.md"), "utf8").split("## Put a live figure on a web page")[1]
  writeFileSync(join(work, "phong.lua"), /```lua\n([^]*?)```/.exec(text)[1])
  writeFileSync(join(work, "recipe.html"), `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,">${/```html\n([^]*?)```/.exec(text)[1]}`)
  run("publish", "phong.lua", "-o", "phong.html")
  run("phong.lua", "-o", "phong.png", "--quiet")
  const page = await open("recipe.html"), [live, embedded, frame] = [figureOf(page, 0), figureOf(page, 1), page.frameLocator("iframe").locator("glint-figure")]
  await live.scrollIntoViewIfNeeded()
  await ready(live)
  check(await shiftOf(page) < 0.1, `recipe: layout shift ${await shiftOf(page)}`)
  check(await same(page, live, "phong.lua", "--set", "n=8"), "recipe: the element")
  check(await live.locator("math").count() === 2, "recipe: formulas")
  await live.getByLabel("n", { exact: true }).focus()
  await page.keyboard.press("End")
  await page.waitForFunction(() => document.getElementById("exponent").value === "256")
  await page.getByRole("button", { name: "Sharper" }).click()
  check(await same(page, live, "phong.lua", "--set", "n=128"), "recipe: an attribute")
  await embedded.scrollIntoViewIfNeeded()
  await ready(embedded)
  check(await same(page, embedded, "phong.lua", "--set", "n=64"), "recipe: a published page in an element")
  await page.locator("iframe").scrollIntoViewIfNeeded()
  await frame.locator("canvas").waitFor({ state: "visible" })
  check(await same(page, frame, "phong.lua", "--set", "n=16", "--orbit", "30,10"), "recipe: a published page in a frame")
  await page.screenshot({ path: join(work, "recipe.png"), fullPage: true })
  await close(page, "recipe")
}

// The pages of make web work from a disk. Their layout does not shift when the engine starts.
async function disk() {
  for (const name of ["figure.html", "course.html"]) {
    const page = await open(`file://${join(web, name)}`), figure = figureOf(page)
    await figure.scrollIntoViewIfNeeded()
    await ready(figure)
    check(await figure.locator(".control").count() > 0, `disk: ${name} has controls`)
    await close(page, `disk: ${name}`)
  }
  const page = await open("course.html")
  await figureOf(page).locator(".control").first().waitFor({ state: "attached" })
  const places = () => page.locator("h2").evaluateAll(all => all.map(one => one.getBoundingClientRect().top + scrollY))
  const before = await places()
  for (let i = 0; i < 3; i++) {
    await figureOf(page, i).scrollIntoViewIfNeeded()
    await ready(figureOf(page, i))
    await settled(figureOf(page, i))
  }
  const after = await places()
  check(after.every((place, i) => Math.abs(place - before[i]) < 1), `course: headings have moved: ${after.map((place, i) => Math.round(place - before[i]))}`)
  check(await shiftOf(page) < 0.1, `course: layout shift ${await shiftOf(page)}`)
  await page.locator(".open a").nth(1).click()
  await page.waitForFunction(() => document.getElementById("state")?.textContent === "ready")
  check((await page.locator(".cm-content").innerText()).includes("Lambert's cosine law"), "course: a link opens the playground")
  await close(page, "course")
}

// The npm package in a bundler: the element and the module come from "glint-render".
async function bundled() {
  const site = join(work, "site"), own = join(site, "node_modules/glint-render")
  cpSync(web, own, { recursive: true, filter: path => !/examples|course/.test(path) })
  writeFileSync(join(site, "app.js"), 'import "glint-render/figure"\nimport { load } from "glint-render"\ndocument.title = typeof load\n')
  execFileSync(join(dirname(fileURLToPath(import.meta.url)), "node_modules/.bin/esbuild"), ["app.js", "--bundle", "--format=esm", "--external:node:*", "--outfile=bundle.js", "--log-level=error"], { cwd: site })
  for (const name of ["glint.wasm", "worker.mjs", "glint.ttf"]) cpSync(join(own, name), join(site, name))
  cpSync(join(work, "lamp.lua"), join(site, "lamp.lua"))
  writeFileSync(join(site, "index.html"), '<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><script type="module" src="bundle.js"></script><glint-figure src="lamp.lua" shininess="5"></glint-figure>')
  const page = await open("site/index.html")
  await ready(figureOf(page))
  check(await same(page, figureOf(page), "--set", "shininess=5") && await page.title() === "function", "bundled: the picture of the package's element")
  await close(page, "bundled")
}

// The playground has the same hands.
async function playground() {
  const page = await open("index.html#src=lamp.lua")
  const quiet = () => page.waitForFunction(() => document.getElementById("state").textContent === "ready")
  await quiet()
  await page.locator(".handle").waitFor()
  const codes = () => page.locator("#picture").evaluate(shown => [...shown.getContext("2d").getImageData(0, 0, shown.width, shown.height).data].join())
  const turnsBy = async (from, dx) => {
    const before = await codes()
    await page.mouse.move(...from)
    await page.mouse.down()
    await page.mouse.move(from[0] + dx / 2, from[1])
    await page.mouse.move(from[0] + dx, from[1])
    await page.mouse.up()
    await page.waitForTimeout(400)
    await quiet()
    return await codes() !== before
  }
  const picture = await boxOf(page.locator("#hands"))
  check(await turnsBy([picture.x + 30, picture.y + 30], 60), "playground: a drag turns the view")
  check(await turnsBy(middleOf(await boxOf(page.locator(".handle"))), -40), "playground: a drag moves the lamp")
  check(await page.getByLabel("Lamp x").inputValue() !== "1.5", "playground: the fields follow")
  await close(page, "playground")
}

await runAll([controls, attributes, errors, hands, phone, published, recipe, bundled, disk, playground])
