// The piece of time that plots and timeline show: it goes along with the simulation, or stays where
// somebody has moved it.

export const leastSpanS = 0.2;
export const defaultSpanS = 10;

export class TimeWindow {
  span = defaultSpanS;
  /** Right end [s]; null: it follows the newest frame. */
  private fixedEnd: number | null = null;

  constructor(private readonly longest: number) {}

  get following(): boolean {
    return this.fixedEnd === null;
  }

  /** First and last time shown, given the newest one. */
  range(newest: number): [number, number] {
    const end = this.fixedEnd ?? Math.max(this.span, newest);
    return [end - this.span, end];
  }

  /** Shows less (factor < 1) or more about a time that stays where it is. */
  zoom(factor: number, about: number | null, newest: number): void {
    const [start, end] = this.range(newest);
    const span = Math.min(this.longest, Math.max(leastSpanS, this.span * factor));
    if (about !== null && !this.following) {
      const share = (end - about) / (end - start);
      this.fixedEnd = about + share * span;
    }
    this.span = span;
  }

  /** Moves by so many seconds; what lies beyond the newest frame is followed. */
  pan(seconds: number, oldest: number, newest: number): void {
    const [, end] = this.range(newest);
    const moved = Math.max(oldest + this.span, end + seconds);
    this.fixedEnd = moved >= newest ? null : moved;
  }

  /** Stays where it is. */
  hold(newest: number): void {
    this.fixedEnd ??= this.range(newest)[1];
  }

  centreOn(t: number, newest: number): void {
    const end = t + this.span / 2;
    this.fixedEnd = end >= newest ? null : end;
  }

  follow(): void {
    this.fixedEnd = null;
  }

  reset(): void {
    this.span = defaultSpanS;
    this.follow();
  }
}
