// Decodes a PNG of 8 or 16 bits a channel, RGB or RGBA, for the tests.
import zlib from "node:zlib"

const paeth = (a, b, c) => {
  const p = a + b - c, pa = Math.abs(p - a), pb = Math.abs(p - b), pc = Math.abs(p - c)
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c
}

export function decode(file) {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength), parts = []
  for (let at = 8; at < file.length; at += 12 + view.getUint32(at))
    if (String.fromCharCode(...file.subarray(at + 4, at + 8)) === "IDAT") parts.push(file.subarray(at + 8, at + 8 + view.getUint32(at)))
  const width = view.getUint32(16), height = view.getUint32(20), bits = file[24], channels = file[25] === 6 ? 4 : 3
  const raw = zlib.inflateSync(Buffer.concat(parts)), step = channels * bits / 8, stride = width * step
  const out = new Uint8Array(height * stride)
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (stride + 1)]
    for (let i = 0; i < stride; i++) {
      const at = y * stride + i, a = i >= step ? out[at - step] : 0, b = y ? out[at - stride] : 0
      const c = i >= step && y ? out[at - stride - step] : 0
      out[at] = raw[y * (stride + 1) + 1 + i] + [0, a, b, a + b >> 1, paeth(a, b, c)][filter]
    }
  }
  const rgba = new Uint8ClampedArray(4 * width * height).fill(255)
  for (let i = 0; bits === 8 && i < width * height; i++) for (let c = 0; c < channels; c++) rgba[4 * i + c] = out[channels * i + c]
  return { width, height, bits, channels, rgba }
}
