/** The motion of a phone in the hand as a base motion: what it feels along its screen, tilt included. */

/** What a phone feels at a time [s], along the screen to the right and upwards [m/s²]. */
export interface Felt {
  readonly time: number;
  readonly x: number;
  readonly y: number;
}

/** How long a phone is moved [s]. */
export const LENGTH = 10;
/** Time between the accelerations of the record [s]. */
const STEP = 0.02;
/** The mean over this first part of the motion counts as level [s]. */
const LEVEL = 0.2;
/** A device that has not reported its motion by then has no sensor [s]. */
const PATIENCE = 1.5;

const NO_SENSOR = "This device does not report its motion.";
const FORBIDDEN = "The browser does not let this page read the motion of the device.";

/** iOS asks its user first. */
interface Asking {
  readonly requestPermission?: () => Promise<string>;
}

/** Returns whether a phone may be moved here: a touch screen, and a browser that reports motion to this page. */
export function canFeel(): boolean {
  return window.isSecureContext && "DeviceMotionEvent" in window && navigator.maxTouchPoints > 0;
}

/** Listens while the phone is moved; `heard` gets the seconds that are left. */
export async function feel(seconds: number, heard: (left: number) => void): Promise<readonly Felt[]> {
  const ask = (DeviceMotionEvent as unknown as Asking).requestPermission;
  if (ask !== undefined && (await ask().catch(() => "denied")) !== "granted") throw new Error(FORBIDDEN);
  const felt: Felt[] = [];
  const begun = performance.now();
  const listen = ({ accelerationIncludingGravity: feels, timeStamp }: DeviceMotionEvent): void => {
    if (feels?.x == null || feels.y == null) return;
    felt.push({ time: (timeStamp - begun) / 1000, x: feels.x, y: feels.y });
  };
  window.addEventListener("devicemotion", listen);
  try {
    for (let passed = 0; passed < seconds; passed = (performance.now() - begun) / 1000) {
      if (felt.length === 0 && passed > PATIENCE) throw new Error(NO_SENSOR);
      heard(Math.ceil(seconds - passed));
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
  } finally {
    window.removeEventListener("devicemotion", listen);
  }
  if (felt.length < 2) throw new Error(NO_SENSOR);
  return felt;
}

/** Returns the accelerations at equal steps as a table: linear between the times, and zero for the first attitude. */
export function tableOf(felt: readonly Felt[]): string {
  const [first, last] = [felt[0]?.time ?? 0, felt.at(-1)?.time ?? 0];
  const still = felt.filter(({ time }) => time <= first + LEVEL);
  const mean = (of: (one: Felt) => number): number => still.reduce((sum, one) => sum + of(one), 0) / still.length;
  const [levelX, levelY] = [mean(({ x }) => x), mean(({ y }) => y)];
  const rows = Array.from({ length: Math.floor((last - first) / STEP) + 1 }, (_, k) => {
    const { x, y } = between(felt, first + k * STEP);
    return [k * STEP, x - levelX, y - levelY].map((value) => Number(value.toFixed(4))).join();
  });
  return ["time [s],x [m/s2],y [m/s2]", ...rows, ""].join("\n");
}

function between(felt: readonly Felt[], time: number): { readonly x: number; readonly y: number } {
  const after = Math.max(
    1,
    felt.findIndex((one) => one.time >= time),
  );
  const [a, b] = [felt[after - 1], felt[after]];
  if (!a || !b) return felt.at(-1) ?? { x: 0, y: 0 };
  const share = Math.min(Math.max((time - a.time) / (b.time - a.time), 0), 1);
  return { x: a.x + share * (b.x - a.x), y: a.y + share * (b.y - a.y) };
}
