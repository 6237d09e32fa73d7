/** When each part of the rim touched: the material point that touches stands at the angle β − χ of the body. */

import type { DrawnMotion } from "./drawn-motion";
import { placeOf } from "./moment";
import { onRim } from "./touching";

const TURN = 2 * Math.PI;
const JUMP = 0.5 * Math.PI; // a point that goes further between samples has not rolled there

export class RimVisits {
  readonly #times: readonly (readonly number[])[];

  constructor(
    motion: DrawnMotion,
    readonly sectors: number,
  ) {
    const times: number[][] = Array.from({ length: sectors }, () => []);
    for (let i = 0; i + 1 < motion.time.length; i += 1) {
      if (!onRim(motion, i)) continue;
      const from = bodyAngle(motion, i);
      const way = wrapped(bodyAngle(motion, i + 1) - from);
      const steps = Math.abs(way) > JUMP ? 0 : Math.ceil((Math.abs(way) / TURN) * sectors);
      for (let step = 0; step <= steps; step += 1) {
        const part = steps === 0 ? 0 : step / steps;
        const sector = Math.floor(((((from + part * way) / TURN) % 1) + 1) * sectors) % sectors;
        times[sector]!.push(motion.time[i]! + part * (motion.time[i + 1]! - motion.time[i]!));
      }
    }
    this.#times = times;
  }

  /** Return when this sector last touched, up to `time`; null if it never did. */
  last(sector: number, time: number): number | null {
    const times = this.#times[sector]!;
    if (times.length === 0 || times[0]! > time) return null;
    return times[placeOf(times, time).index]!;
  }
}

function bodyAngle(motion: DrawnMotion, i: number): number {
  const [contact, footprint] = [motion.contact_point[i]!, motion.footprint[i]!];
  return Math.atan2(contact[1] - footprint[1], contact[0] - footprint[0]) - motion.twist[i]!;
}

function wrapped(angle: number): number {
  return angle - TURN * Math.round(angle / TURN);
}
