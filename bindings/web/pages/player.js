// Plays frames in order, as fast as they are rendered, and at most at the animation's frame rate.
export class Player {
  constructor(frames, fps, go) {
    Object.assign(this, { frames, fps, go })
    this.frame = 1
    this.playing = false
  }

  toggle() {
    this.playing = !this.playing
    this.due = performance.now()
    if (this.playing) this.step()
  }

  step() {
    this.frame = this.frame % this.frames + 1
    this.due = Math.max(performance.now(), this.due + 1000 / this.fps)
    this.go(this.frame)
  }

  // Called when a frame is shown.
  shown() {
    clearTimeout(this.timer)
    if (this.playing) this.timer = setTimeout(() => this.playing && this.step(), Math.max(0, this.due - performance.now()))
  }
}
