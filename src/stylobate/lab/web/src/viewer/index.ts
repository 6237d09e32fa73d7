/** The column in space: `Stage` draws a motion at any time, `Clock` runs that time. */

export { Clock } from "./clock";
export type { Beside, DrawnColumn, DrawnMotion, DrawnPlane, Pair, Rotation, Triple } from "./drawn-motion";
export type { Theme } from "./palette";
export { type Pose, Stage, type StageOptions } from "./stage";
export { computedUntil, isFalling, withFall } from "./fall";
