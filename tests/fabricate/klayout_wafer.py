"""What KLayout sees of a wafer: klayout -b -rd folder=DIR -r klayout_wafer.py. Prints facts as NAME VALUE."""
import pya

GDS, OASIS = pya.Layout(), pya.Layout()
GDS.read(folder + "/wafer.gds")
OASIS.read(folder + "/wafer.oas")
LAYERS = sorted({i.layer for i in GDS.layer_infos()})


def own(layout, cell, layer):
    return pya.Region(cell.shapes(layout.layer(layer, 0)))


def placed(layout, cell):
    """Where every instance stands, and the steps of those that are repeated."""
    out = []
    for i in cell.each_inst():
        steps = sorted((v.x, v.y, n) for v, n in ((i.a, i.na), (i.b, i.nb)) if n > 1)
        out.append((i.cell.name, i.trans.disp.x, i.trans.disp.y, steps))
    return sorted(out)


differing, xor_area = 0, 0
for cell in GDS.each_cell():
    other = OASIS.cell(cell.name)
    if other is None or placed(GDS, cell) != placed(OASIS, other):
        differing += 1
        continue
    for layer in LAYERS:
        xor_area += (own(GDS, cell, layer) ^ own(OASIS, other, layer)).area()
print("cells_that_differ", differing)
print("cells_only_in_oasis", OASIS.cells() - GDS.cells())
print("xor_of_cells", xor_area)

# Flat, where the pads of fields have their lower left corners.
top, flat_xor, seen = GDS.top_cell(), 0, 0
for i in top.each_inst():
    if not i.cell.name.startswith("FIELD_"):
        continue
    box = i.cell.bbox().transformed(i.trans)
    window = pya.Box(box.left, box.bottom + 2000000, box.left + 100000, box.bottom + 2200000)
    for layer in LAYERS:
        regions = []
        for layout in (GDS, OASIS):
            it = layout.top_cell().begin_shapes_rec_touching(layout.layer(layer, 0), window)
            regions.append(pya.Region(it) & pya.Region(window))
        flat_xor += (regions[0] ^ regions[1]).area()
        seen += regions[0].area()
print("flat_xor", flat_xor)
print("flat_seen", seen)

print("top_cells", len(list(GDS.top_cells())))
print("hierarchy", top.hierarchy_levels())
print("fields", sum(1 for i in top.each_inst() if i.cell.name.startswith("FIELD_")))
print("cells", GDS.cells())
for layer in LAYERS:
    print("name_%d" % layer, OASIS.get_info(OASIS.layer(layer, 0)).name.replace(" ", "_"))

# Sizes of ten features: bars, ruler, holes by their area, pitch of an array.
sizes = own(GDS, GDS.cell("SIZES"), 1)
bars = sorted({(s.bbox().width(), s.bbox().height()) for s in sizes.each() if s.bbox().bottom == 0})
for k, (width, height) in enumerate(bars):
    print("bar_%d" % k, width * GDS.dbu)
ruler = [s.bbox() for s in sizes.each() if s.bbox().top < 0]
print("ruler", (max(b.center().x for b in ruler) - min(b.center().x for b in ruler)) * GDS.dbu)
for name in designs.split(","):
    cell = GDS.cell("DESIGN_%s_CELL" % name)
    area = sum(own(GDS, cell, layer).merged().area() for layer in LAYERS) * GDS.dbu ** 2
    print("diameter_%s" % name, (4 * area / 3.141592653589793) ** 0.5)
array = next(i for i in GDS.cell("DESIGN_%s" % designs.split(",")[0]).each_inst())
print("pitch", max(array.a.x, array.b.x) * GDS.dbu)
print("copies", array.na * array.nb)

# Letters of a field as a microscope would show them: rows from the top, squares as bits.
field = GDS.cell("FIELD_" + field_id)
letters = sorted((i.trans.disp.x, i.trans.disp.y, i.cell) for i in field.each_inst() if i.cell.name.startswith("GLYPH_"))
square = min(s.bbox().height() for s in own(GDS, letters[0][2], 1).each())
left, bottom = letters[0][0], letters[0][1]
word = pya.Region(pya.RecursiveShapeIterator(GDS, field, GDS.layer(1, 0), pya.Box(left, bottom, left + 60 * square, bottom + 7 * square)))
word.merge()
for row in range(7):
    y = bottom + (6 - row) * square + square // 2
    bits = ""
    for column in range(int(columns)):
        x = left + column * square + square // 2
        bits += "#" if not (word & pya.Region(pya.Box(x - 1, y - 1, x + 1, y + 1))).is_empty() else "."
    print("word_%d" % row, bits)
print("letter_height", 7 * square * GDS.dbu)
