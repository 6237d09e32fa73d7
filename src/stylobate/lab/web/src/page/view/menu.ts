/** What the export menu takes along of the view that is shown. */

import { caseInWords, written } from "../case/description";
import { ExportMenu } from "../frame/exports";
import { clockTime } from "../frame/format";
import { joined } from "../frame/units";
import type { MotionView } from "../motion/motion-view";
import { verdictOf } from "../motion/verdict";
import type { Described, Run as Answer } from "../server/schema";
import { sent } from "../server/requests";
import type { Source } from "../server/source";
import { linkOf } from "./link";
import type { View } from "./state";

export interface Shown {
  readonly view: View;
  readonly answer: Answer | null;
  /** Of which case the answer is, as it is written. */
  readonly shown: string;
}

/** Returns the menu of a motion; `now` gives what is shown when something is taken. */
export function menuOf(source: Source, motion: MotionView, now: () => Shown): ExportMenu {
  return new ExportMenu({
    source,
    stage: motion.stage,
    caption: () => captionOf(motion, now()),
    description: () => sent(now().view.description),
    described: () => describedIn(source, now()),
    link: () => `${location.href.replace(/[?#].*/, "")}#${linkOf({ ...now().view, time: motion.stoppedAt })}`,
  });
}

function captionOf(motion: MotionView, { view, answer }: Shown): readonly string[] {
  const { time, to } = motion.clock;
  const fall = motion.falling ? " The fall is drawn, not computed." : "";
  const at = `At ${joined(clockTime(time, to), "s")} of ${joined(clockTime(to, to), "s")}.${fall}`;
  const { second } = motion;
  const beside = second === null ? [] : [`Beside it, ${second.labels[1]}: ${verdictOf(second.answer)}`];
  return answer === null ? [] : [`${verdictOf(answer)} ${at}`, ...beside, caseInWords(view.description)];
}

/** Returns the case in the languages of the package, whether its run has been answered or not. */
async function describedIn(source: Source, { view: { description }, answer, shown }: Shown): Promise<Described> {
  return answer !== null && shown === written(description) ? answer : source.describe(sent(description));
}
