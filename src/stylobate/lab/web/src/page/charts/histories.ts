/** Tilt and demand on the contact over time. */

import type { Answer, Numbers } from "../answers";
import { told } from "../format";
import { TimeChart } from "./time-chart";

export class Histories {
  readonly tilt: TimeChart;
  readonly demand: TimeChart;

  constructor(seek: (time: number) => void) {
    this.tilt = new TimeChart({ title: "Tilt", label: "|θ|/c", timeLabel: "", colour: "blue" }, seek);
    this.demand = new TimeChart(
      { title: "Friction needed at the contact", label: "T/N", timeLabel: "time [s]", colour: "green" },
      seek,
    );
  }

  show(answer: Answer): void {
    const { time, amplitude, friction_demand: demand } = answer.series;
    const c = answer.column.slenderness;
    const tilt = amplitude.map((value) => (value === null ? null : value / c));
    const largest = largestOf(tilt);
    this.tilt.show(time, tilt, levelOne(largest), Math.min(largest, FARTHEST), `largest ${told(largest)} c`);
    this.#showDemand(time, demand ?? null, answer.drawn.friction_coefficient);
  }

  setTime(time: number): void {
    this.tilt.setTime(time);
    this.demand.setTime(time);
  }

  redraw(): void {
    this.tilt.redraw();
    this.demand.redraw();
  }

  #showDemand(time: readonly number[], demand: Numbers | null, coefficient: number | null): void {
    if (demand === null) {
      this.demand.show([], [], null, 1, "this model tells no forces at the contact");
      return;
    }
    const largest = largestOf(demand);
    const level =
      coefficient === null ? null : { value: coefficient, told: `friction coefficient ${told(coefficient)}` };
    // Where the column hardly presses, the ratio is huge for an instant; the rest is what is to be seen.
    const usual = Math.max(quantile(demand, 0.99) * 1.2, (coefficient ?? 0) * 1.25);
    this.demand.show(time, demand, level, Math.min(largest, usual) || (coefficient ?? 1), `largest ${told(largest)}`);
  }
}

/** In units of c: what falls is seen to leave, and what came before is still seen. */
const FARTHEST = 2.5;

function levelOne(largest: number): { value: number; told: string } | null {
  return largest > 0.7 ? { value: 1, told: "c" } : null;
}

export function largestOf(values: Numbers): number {
  return values.reduce<number>((most, value) => (value !== null && value > most ? value : most), 0);
}

export function quantile(values: Numbers, share: number): number {
  const known = values.filter((value): value is number => value !== null).sort((a, b) => a - b);
  return known[Math.floor(share * (known.length - 1))] ?? 0;
}
