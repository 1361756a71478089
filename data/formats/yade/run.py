# Made with YADE 2023.02a:  yade -n -x run.py  in this folder; then xz *.csv. Four plates of facets stand on a floor, a fifth one
# pushes the beads between them towards x = 10 mm.
exec(open("../../maps/yade_export.py").read())
O.materials.append(FrictMat(young=1e7, poisson=0.3, density=2500, frictionAngle=0.4))


def plate(a, b, c, d):
    return O.bodies.append([facet([a, b, c]), facet([a, c, d])])


x, y, z = 0.010, 0.006, 0.02
floor = plate((-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0))
vessel = plate((x, -y, 0), (x, y, 0), (x, y, z), (x, -y, z))
sides = plate((-x, -y, 0), (x, -y, 0), (x, -y, z), (-x, -y, z)) + plate((-x, y, 0), (x, y, 0), (x, y, z), (-x, y, z))
blade = plate((-0.0095, -y, 0), (-0.0095, y, 0), (-0.0095, y, z), (-0.0095, -y, z))
for k in range(60):
    i, j, l = k % 6, (k // 6) % 5, k // 30
    O.bodies.append(sphere((-0.0065 + 0.0026 * i + 0.0002 * l, -0.0046 + 0.0023 * j + 0.0001 * (i % 2), 0.0012 + 0.0022 * l), 0.001))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb()]),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_MindlinPhys(en=0.5, es=0.5)],
                    [Law2_ScGeom_MindlinPhys_Mindlin()]),
    TranslationEngine(ids=blade, translationAxis=(1, 0, 0), velocity=0.1),
    NewtonIntegrator(gravity=(0, 0, -9.81), damping=0),
]
O.dt = 1e-6
jams = JamscopeExport(".", {"floor": floor, "vessel": vessel, "sides": sides, "blade": blade})
for frame in range(4):
    O.run(30000, True)
    jams.write()
