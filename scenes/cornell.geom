The Cornell box in metres, exactly rectangular, lamp 0.1 mm below the ceiling, W/m2
ccw purge
points 28 patches 16 attributes 4
0 0 0
0 0 0.5592
0.5528 0 0.5592
0.5528 0 0
0 0.5488 0
0.5528 0.5488 0
0.5528 0.5488 0.5592
0 0.5488 0.5592
0.13 0.165 0.065
0.082 0.165 0.225
0.24 0.165 0.272
0.29 0.165 0.114
0.13 0 0.065
0.082 0 0.225
0.24 0 0.272
0.29 0 0.114
0.423 0.33 0.247
0.265 0.33 0.296
0.314 0.33 0.456
0.472 0.33 0.406
0.423 0 0.247
0.265 0 0.296
0.314 0 0.456
0.472 0 0.406
0.213 0.5487 0.227
0.343 0.5487 0.227
0.343 0.5487 0.332
0.213 0.5487 0.332
4 1 2 3 4 attribute 1 patch 64
4 5 6 7 8 attribute 1 patch 64
4 2 8 7 3 attribute 1 patch 64
4 4 3 7 6 attribute 2 patch 64
4 1 5 8 2 attribute 3 patch 64
4 9 10 11 12 attribute 1 patch 9
4 9 13 14 10 attribute 1 patch 9
4 10 14 15 11 attribute 1 patch 9
4 11 15 16 12 attribute 1 patch 9
4 12 16 13 9 attribute 1 patch 9
4 17 18 19 20 attribute 1 patch 9
4 17 21 22 18 attribute 1 patch 18
4 18 22 23 19 attribute 1 patch 18
4 19 23 24 20 attribute 1 patch 18
4 20 24 21 17 attribute 1 patch 18
4 25 26 27 28 attribute 4 patch 4
color .725 .71 .68
color .63 .065 .05
color .14 .45 .091
color 0 0 0 emit 53.40708 37.69911 12.56637
