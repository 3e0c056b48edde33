/** How long anything is waited for [ms]: a busy machine is slow. No test waits this long when all is well. */
export const kPatience = 120_000;
