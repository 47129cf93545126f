One triangle
cw nopurge
points 3 patches 1 attributes 1
0 0 0
0 1e0 0
1. 0 0
3 1 2 3
color 1 1 1
