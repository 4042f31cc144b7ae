// Something that the server knows and the page shows, kept up to date one question at a time: answers cannot
// overtake each other, and what is shown last is what was asked last.

export class Reading<T> {
  private asking = false;
  private again = false;
  private outdated = false;

  /** `failed` is by default nothing: the connection's own state tells that the server is away. */
  constructor(
    private readonly ask: () => Promise<T>,
    private readonly use: (answer: T) => void,
    private readonly failed: (error: unknown) => void = () => undefined,
  ) {}

  /** From time to time: nothing new is known of. */
  look(): void {
    if (!this.asking) void this.run();
  }

  /** There is news. An answer that is on its way may tell of before it: one more is asked for after it. */
  refresh(): void {
    this.again = true;
    this.look();
  }

  /** What the page itself has changed: an answer that is on its way tells of before, and is not used. */
  replace(): void {
    this.outdated = this.asking;
    this.refresh();
  }

  private async run(): Promise<void> {
    this.asking = true;
    try {
      do {
        this.again = false;
        this.outdated = false;
        await this.askOnce();
      } while (this.isWantedAgain());
    } finally {
      this.asking = false;
    }
  }

  private async askOnce(): Promise<void> {
    let answer: T;
    try {
      answer = await this.ask();
    } catch (error) {
      if (!this.outdated) this.failed(error);
      return;
    }
    if (!this.outdated) this.use(answer);
  }

  /** Through a method: it changes while an answer is waited for. */
  private isWantedAgain(): boolean {
    return this.again;
  }
}
