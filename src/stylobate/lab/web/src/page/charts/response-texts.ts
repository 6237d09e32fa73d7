/** What stands below the frequency response: whose curves they are, and which exact orbits were found. */

import type { ExactResponse, ResponseCurves } from "../server/answers";
import { counted, formatted, words } from "../frame/format";
import { joined } from "../frame/units";

/** Returns whose curves are shown, and how they were computed. */
export function aboutCurves(curves: ResponseCurves, own: boolean): string {
  const how = curves.averaged ? "by averaging" : "in closed form";
  return own
    ? `Steady rolling, ${how}.`
    : `Steady rolling of a slender column that cannot spin, ${how}; exact orbits are those of this model.`;
}

/** Returns how many families of exact orbits there are, and where they bifurcate. */
export function aboutExact(exact: ExactResponse): string {
  const families = counted(exact.families.length, "family", "families");
  const kinds = [...new Set(exact.bifurcations.map((one) => one.kind))];
  const found = kinds.map((kind) => {
    const places = exact.bifurcations.filter((one) => one.kind === kind).map((one) => one.angular_frequency);
    return `${words(kind)} at ${places
      .sort((a, b) => a - b)
      .map((one) => formatted(one, 4))
      .join(", ")}`;
  });
  return `${families} of exact orbits; ${found.length > 0 ? joined(found.join("; "), "rad/s") : "no bifurcation in the range"}. Click a dot to start on that orbit.`;
}
