# gnuplot -e "data='FOLDER'; images='FOLDER'" plot.gp: the benchmark's data as pictures. A picture whose
# data are missing, as its section was not run, stays as it is.
set encoding utf8
font = "DejaVu Sans,10"
good = "#2a7f62"
bad = "#d1702a"
other = "#4c6a92"
grey = "#888888"

have(name) = int(system(sprintf("test -s '%s/%s.dat' && echo 1 || echo 0", data, name)))
file(name) = sprintf("%s/%s.dat", data, name)

if (have("bars")) {
    stats file("bars") using 2 nooutput
    rows = STATS_records
    set terminal pngcairo size 960, 80 + 22*rows font font noenhanced
    set output sprintf("%s/bench_ratios.png", images)
    set lmargin 54
    set rmargin 18
    set title "How many times better than the bar: measured (bar)"
    set logscale x 10
    set xrange [0.02:50]
    set format x "%g"
    set yrange [rows:-1]
    set grid xtics lc rgb "#e0e0e0" lt 1
    set border 1 lc rgb grey
    set tics textcolor rgb "#333333" nomirror
    unset key
    set style fill solid noborder
    set arrow from 1, graph 0 to 1, graph 1 nohead lc rgb "#333333" lw 1.5 front
    clipped(x) = x < 0.021 ? 0.021 : x > 49 ? 49 : x
    low(x) = clipped(x) < 1 ? clipped(x) : 1
    high(x) = clipped(x) > 1 ? clipped(x) : 1
    plot file("bars") using (1):0:(low($2)):(high($2)):($0 - 0.32):($0 + 0.32):($2 >= 1 ? 0x2a7f62 : 0xd1702a):ytic(1) \
             with boxxyerror lc rgb variable, \
         file("bars") using (high($2)):0:3 with labels left offset 1, 0 tc rgb "#333333"
    unset output
    reset
}

if (have("rays_through_blocks") && have("rays_to_one_object") && have("triage_of_half-spaces") && have("time_of_triage")) {
    stats file("triage_of_half-spaces") using (log($2/($1*log($1)))) name "NLOGN" nooutput
    set terminal pngcairo size 1080, 340 font font noenhanced
    set output sprintf("%s/bench_growth.png", images)
    set multiplot layout 1, 3
    set logscale xy
    set format x "10^{%T}"
    set format x "%g"
    set format y "%g"
    set grid lc rgb "#e8e8e8" lt 1
    set border 3 lc rgb grey
    set tics nomirror textcolor rgb "#333333"
    set key top left Left reverse samplen 1.5
    set style data linespoints
    set pointsize 1.1

    set title "µs per ray"
    set xlabel "rounded blocks; half-spaces in one object"
    set yrange [0.1:30]
    set xtics 10, 10
    plot file("rays_through_blocks") lw 2 pt 7 lc rgb good title "blocks", \
         file("rays_to_one_object") lw 2 pt 5 lc rgb other title "one object, flat parts"

    set title "triage: ms for half-spaces"
    set xlabel "half-spaces in one object"
    set autoscale y
    plot file("triage_of_half-spaces") lw 2 pt 7 lc rgb good title "measured", \
         file("triage_of_half-spaces") using 1:($1*log($1)*exp(NLOGN_mean)) with lines dt 2 lc rgb grey title "n log n"

    set title "seconds for a mesh of obj4"
    set xlabel "radius"
    set xrange [0.3:0.004] reverse
    set xtics (0.2, 0.1, 0.05, 0.02, 0.01, 0.005)
    plot file("time_of_flying_edges") lw 2 pt 5 lc rgb bad title "flying edges, radius/2", \
         file("time_of_triage") lw 2 pt 7 lc rgb good title "triage"
    unset multiplot
    unset output
}
