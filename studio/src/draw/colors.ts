/** The colours that dominoes come in, the same as the program's (`usual_colors` in include/topple/picture.h). */

export const kNamed: [color: string, name: string][] = [
  ['#d92b2b', 'Red'], ['#f0821e', 'Orange'], ['#f2b928', 'Yellow'], ['#3faa46', 'Green'], ['#17a398', 'Teal'], ['#1478c8', 'Blue'],
  ['#2b5bd9', 'Royal blue'], ['#7832be', 'Violet'], ['#c2185b', 'Crimson'], ['#f4f1e8', 'Ivory'], ['#5d6d7e', 'Slate'], ['#23262b', 'Black'],
];
