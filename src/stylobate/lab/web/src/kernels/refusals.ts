/** Why the programs of the page do not answer. */

/** The case has something that no program knows. */
export class Unknown extends Error {}

/** A check of a constructor failed, and the page does not know more. */
export const CONTRADICTION = "these numbers contradict each other, or one is missing: no body or motion has just these";
