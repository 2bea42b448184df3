// Tests the sizes of a live figure's pictures with a clock of its own: a job whose pictures take a given time.
import assert from "node:assert/strict"
import fs from "node:fs"
import os from "node:os"
import path from "node:path"
import { pathToFileURL } from "node:url"

// The module under test, without the engine and the controls.
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "glint-"))
fs.copyFileSync("bindings/web/pages/renderer.js", path.join(folder, "renderer.js"))
for (const [name, text] of Object.entries({ "glint.mjs": "export const load = null", "controls.js": "export const written = String", "package.json": '{ "type": "module" }' }))
  fs.writeFileSync(path.join(folder, name), text)
const { Renderer } = await import(pathToFileURL(path.join(folder, "renderer.js")))
process.on("exit", () => fs.rmSync(folder, { recursive: true }))

let bad = 0
async function test(name, run) {
  try {
    await run()
    console.log(`ok - ${name}`)
  } catch (error) {
    bad++
    console.log(`not ok - ${name}\n${String(error.stack ?? error).slice(0, 2000)}`)
  }
}

// A figure of 640 x 400 CSS pixels whose pictures take `fixed` ms and `sample` ms for each sample, on a clock that only
// pictures move. samples: the samples of a picture at rest. params: the script's parameters. rays: the rays of a sample,
// which share its time evenly.
function figure({ fixed, sample, density = 1, samples = 1, params, rays = 1 }) {
  const seen = [], sizesOfJob = [], clock = { time: 0, now: () => clock.time }
  let wake
  const picture = ({ width, height, samples: wanted = samples, ...rest }, done = wanted) => {
    const pixelMs = sample() * width * height * done * Math.min(1, (rest.rays ?? rays) / rays)
    clock.time += fixed() + pixelMs
    return { width, height, samples: done, ownSamples: wanted, pixelMs, ...rest }
  }
  const render = async options => {
    sizesOfJob.push(options.width)
    return picture(options)
  }
  const job = { samples, params, render, another: async () => ({ ...job, render: async options => picture(options) }), close: () => {},
    async *steps(options) {
      for (let done = 1; done < (options.samples ?? samples); done *= 2) yield picture(options, done)
      yield picture(options)
    } }
  const one = { seen, sizesOfJob, clock, fail: undefined }
  const renderer = new Renderer(job, { page: () => ({ width: 640, height: 400 }), density: () => density, clock,
    shown: (image, how) => { seen.push({ ...image, ...how }); wake?.() }, failed: error => { one.fail = error; wake?.() } })
  const next = () => new Promise(done => { wake = done })
  one.step = async n => { const shown = next(); renderer.ask({ set: { n } }); await shown; assert.equal(one.fail, undefined) }
  one.rest = async () => { while (!seen.length || seen.at(-1).coarse) await next() }
  one.prepared = () => new Promise(done => setTimeout(done, 1)) // the pictures that are not shown
  // Moves a control through 40 steps. Returns the pictures shown.
  one.drag = async () => {
    seen.length = 0
    for (let n = 0; n < 40; n++) await one.step(n)
    return seen.splice(0)
  }
  return one
}

const sizes = pictures => [...new Set(pictures.map(one => `${one.width}x${one.height}`))]

await test("a picture at rest has the screen's pixels and four samples", async () => {
  for (const [density, width, height] of [[1, 640, 400], [1.5, 960, 600], [3, 1280, 800]]) {
    const one = figure({ fixed: () => 4, sample: () => 1e-5, density })
    await one.step(0)
    await one.rest()
    const { width: wide, height: high, samples, layers } = one.seen.at(-1)
    assert.deepEqual([wide, high, samples, layers], [width, height, 4, { width: 640, height: 400, least: 12 }])
  }
  const own = figure({ fixed: () => 4, sample: () => 1e-5, samples: 16 })
  await own.step(0)
  await own.rest()
  assert.equal(own.seen.at(-1).samples, 16)
})

await test("a fixed part does not shrink the picture", async () => {
  const one = figure({ fixed: () => 24, sample: () => 1e-4 }) // 160,000 samples fit into 40 ms
  await one.step(0)
  await one.rest()
  const pictures = await one.drag()
  assert.deepEqual(sizes(pictures), ["506x316"]) // sqrt(160,000 / 256,000) of 640 x 400
  await one.rest()
})

await test("a drag changes its size rarely, and answers in 50 ms", async () => {
  let factor = 1
  const one = figure({ fixed: () => 5 * factor, sample: () => 4e-4 * factor })
  await one.step(0)
  await one.rest()
  for (factor of [0.3, 3, 1, 0.1]) { // the browser compiles; the machine is busy; ...
    const pictures = await one.drag(), found = sizes(pictures)
    assert(found.length <= 2, `factor ${factor}: ${found}`)
    for (const { ms } of pictures.slice(5)) assert(ms <= 50, `factor ${factor}: ${ms} ms`)
    const most = Math.min(256000, (40 - 5 * factor) / (4e-4 * factor)), last = pictures.at(-1)
    assert(last.width * last.height > most / 1.7, `factor ${factor}: ${found}; ${most} pixels fit`)
    await one.rest()
  }
})

await test("a picture of the same values, which is reused, does not count", async () => {
  let isRepeated = false
  const one = figure({ fixed: () => 4, sample: () => isRepeated ? 0 : 2e-3 }) // 18,000 samples fit into 40 ms
  await one.step(0)
  await one.rest()
  one.seen.length = 0
  for (let n = 1; n < 20; n++)
    for (isRepeated of [false, true]) await one.step(n)
  assert.ok(one.seen.every(({ width }) => width < 256), `${sizes(one.seen)}`)
})

await test("a drag whose pictures become much slower shrinks them once more", async () => {
  let cost = 1e-5
  const one = figure({ fixed: () => 4, sample: () => cost })
  await one.step(0)
  await one.rest()
  one.seen.length = 0
  for (let n = 1; n < 40; n++) {
    if (n === 10) cost = 2e-3
    await one.step(n)
  }
  const last = one.seen.slice(-20)
  assert.ok(last.every(({ width }) => width < 256), `${sizes(last)}`)
  assert.ok(sizes(one.seen).length <= 3, `${sizes(one.seen)}`)
})

await test("a drag that leaves half of its time grows once more", async () => {
  let cost = 2e-3
  const one = figure({ fixed: () => 4, sample: () => cost })
  await one.step(0)
  await one.rest()
  one.seen.length = 0
  for (let n = 1; n < 40; n++) {
    if (n === 10) cost = 4e-4 // 90,000 samples fit
    await one.step(n)
  }
  assert.ok(one.seen.slice(-10).every(({ width, height }) => width * height > 60000), `${sizes(one.seen)}`)
  assert.ok(sizes(one.seen).length <= 4, `${sizes(one.seen)}`)
})

await test("a very heavy figure keeps 160 pixels while a control moves, or answers in 200 ms", async () => {
  for (const [sample, wide] of [[5e-3, 160], [0.05, 79]]) {
    const one = figure({ fixed: () => 4, sample: () => sample })
    await one.step(0)
    await one.rest()
    for (const { width } of (await one.drag()).slice(5)) assert.equal(width, wide)
    await one.rest()
  }
})

await test("a very heavy figure grows back to 160 pixels when the machine is free again", async () => {
  let factor = 8
  const one = figure({ fixed: () => 4, sample: () => 4e-3 * factor })
  await one.step(0)
  await one.rest()
  one.seen.length = 0
  for (let n = 1; n < 40; n++) {
    if (n === 10) factor = 1
    await one.step(n)
  }
  assert.ok(one.seen[8].width < 160 && one.seen.at(-1).width === 160, `${sizes(one.seen)}`)
})

await test("the first picture of each drag has the size of a picture whose rays are kept", async () => {
  const one = figure({ fixed: () => 4, sample: () => 1e-3, params: [{ name: "n" }] })
  await one.step(0)
  await one.rest()
  for (let n = 0; n < 3; n++) {
    await new Promise(done => setTimeout(done)) // the picture that is not shown
    const before = one.sizesOfJob.at(-1)
    const pictures = await one.drag()
    assert.equal(pictures[0].width, before)
    await one.rest()
    assert.equal(one.sizesOfJob.at(-1), pictures.at(-1).width, "another job renders the picture at rest")
  }
})

await test("a figure that the page asks for twice at the start is measured, too", async () => {
  const one = figure({ fixed: () => 4, sample: () => 3e-4, params: [{ name: "n", type: "number", min: 0, max: 40, value: 0 }] })
  one.step(0)
  await one.step(0)
  await one.rest()
  await one.prepared()
  assert.equal(one.sizesOfJob.at(-1), 438) // 120,000 samples fit; this picture is not shown
  assert.deepEqual(sizes(await one.drag()), ["438x274"])
})

await test("a figure with many rays sends fewer while a control moves, and all at rest", async () => {
  for (const [sample, rays, width] of [[1e-4, undefined, 640], [8e-4, 2, 640], [5e-3, 1, 429]]) { // 115,000 samples fit
    const one = figure({ fixed: () => 4, sample: () => sample, rays: 16, params: [{ name: "n", type: "number", min: 0, max: 40, value: 0 }] })
    await one.step(0)
    await one.rest()
    for (let n = 0; n < 3; n++) {
      await one.prepared()
      for (const picture of await one.drag()) assert.deepEqual([picture.rays, picture.width], [rays, width])
      await one.rest()
      assert.deepEqual([one.seen.at(-1).rays, one.seen.at(-1).samples], [undefined, 4])
    }
  }
})

await test("other work of the machine changes the size of a drag's pictures at most once", async () => {
  let seed = 1
  const random = () => (seed = seed * 16807 % 2147483647) / 2147483647
  for (const most of [2, 4]) { // one picture in three takes up to this time more
    const load = () => random() < 1 / 3 ? 1 + most * random() : 1
    const one = figure({ fixed: () => 8 * load(), sample: () => 9e-5 * load(), params: [{ name: "n", type: "number", min: 0, max: 40, value: 0 }] })
    await one.step(0)
    await one.rest()
    await one.prepared()
    let changes = 0
    for (let n = 0; n < 20; n++) {
      const found = sizes(await one.drag())
      assert(found.length <= 2, `load ${most}: ${found}`)
      changes += found.length - 1
      await one.rest()
    }
    assert(changes <= 5, `load ${most}: ${changes} of 20 drags changed their size`)
  }
})

await test("a script that alone takes too long still has a picture", async () => {
  const one = figure({ fixed: () => 200, sample: () => 2e-4 })
  await one.step(0)
  await one.rest()
  for (const { width } of await one.drag()) assert(width > 300, `${width} pixels`)
  await one.rest()
})

await test("a slow picture appears in smaller sizes first", async () => {
  const one = figure({ fixed: () => 5, sample: () => 0.03 }) // 7.7 s
  await one.step(0)
  await one.rest()
  assert.deepEqual(one.seen.map(({ width, samples }) => [width, samples]), [[160, 1], [320, 1], [640, 1], [640, 2], [640, 4]])
})

console.log(`${bad ? "not all" : "all"} is well`)
process.exit(bad ? 1 : 0)
