// One time for the replay, the film and the charts.

const rates = [0.05, 0.1, 0.25, 0.5, 1, 2];

export class Clock {
  time_s: number;
  rate = 1;
  playing = false;
  private listeners: (() => void)[] = [];
  private frame_requested = false;
  private last_frame_ms = 0;

  constructor(readonly begin_s: number, readonly end_s: number) {
    this.time_s = begin_s;
  }

  /// The listener is called at most once per picture of the browser, after the time or the playing changed.
  subscribe(listener: () => void): void {
    this.listeners.push(listener);
    this.request();
  }

  seek(time_s: number): void {
    this.time_s = Math.min(Math.max(time_s, this.begin_s), this.end_s);
    this.request();
  }

  play(): void {
    if (this.time_s >= this.end_s) this.time_s = this.begin_s;
    this.playing = true;
    this.last_frame_ms = performance.now();
    this.request();
  }

  pause(): void {
    this.playing = false;
    this.request();
  }

  /// Nobody is told any more.
  close(): void {
    this.playing = false;
    this.listeners = [];
  }

  /// The next faster (+1) or slower (-1) rate.
  change_rate(step: number): void {
    const index = rates.indexOf(this.rate) + step;
    this.rate = rates[Math.min(Math.max(index, 0), rates.length - 1)];
    this.request();
  }

  private request(): void {
    if (this.frame_requested) return;
    this.frame_requested = true;
    requestAnimationFrame((now_ms) => this.frame(now_ms));
  }

  private frame(now_ms: number): void {
    this.frame_requested = false;
    if (this.playing) {
      // A tab that slept does not jump: no picture advances by more than a quarter of a second.
      const elapsed_s = Math.min(Math.max(now_ms - this.last_frame_ms, 0) / 1000, 0.25);
      this.last_frame_ms = now_ms;
      this.time_s = Math.min(this.time_s + elapsed_s * this.rate, this.end_s);
      if (this.time_s >= this.end_s) this.playing = false;
    }
    for (const listener of this.listeners) listener();
    if (this.playing) this.request();
  }
}
