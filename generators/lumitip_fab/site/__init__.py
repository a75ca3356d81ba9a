"""One page about an output folder, which opens by double click and needs no network.

folder    the files of an output folder that the page shows
cells     what belongs to each cell: parts, nets, wires, numbers
wires     the list of cables, and where its wires lead
boards    boards as drawings with copper by net
masks     masks at 1:1, and the grid of cells
targets   what a line of a table is about
tables    bill, printed parts, orders, files, figures beside the publication
checks    every check with value, limit and margin
beds      printed parts on the bed
library   three.js with its licence
page      the page itself

`page.html` and `page.css` are its form. Scripts, in the order in which it has them: `follow.js` (a
cell in all panels), `tables.js`, `scene.js`, `viewer.js`, `turn.js`, `model.js` and `bed.js`
(3D), `rays.js`, `twin.js` and `grasp.js` (the optical twin), `start.js`.
"""
