A lamp over a floor
ccw purge
points 8 patches 2 attributes 2
0 0 0 normal 0 1 0
0 0 3
4 0 3
4 0 0
1 2 1
2 2 1
2 2 2
1 2 2
4 1 2 3 4 attribute 1 patch 9
4 5 6 7 8 attribute 2
color .7 .6 .5
color 0 0 0 emit 3 2 1 material 7
