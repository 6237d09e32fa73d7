/** Why a check of a constructor failed, where the page does not know more. */
export const CONTRADICTION = "these numbers contradict each other, or one is missing: no body or motion has just these";
