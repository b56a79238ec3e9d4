#!/usr/bin/env python3
"""film_trial.py DIR --films 40 --make BUILD/bench/make_films --tumble BUILD/cli/tumble [--name NAME] [--seed 4]

Can the errors be believed? Films of our own with varied camera, light and noise (docs/films.md) are made in DIR, once,
analysed with what a laboratory would know, and compared with their truth: a table per film, and per quantity how often
the truth lies within 2 standard errors (90 to 98 % is right), the median |z|, and the median error. Every other film
is analysed with --recorded-fps. Needs python3-numpy.

Truth of the charge is that of the mill in the long run, which whoever films it wants to know: of the film's frames, plus
what `make_films mean` finds 8 times as long a run to differ from them (--same-frames leaves that out). Balls are placed
as if they touched the glass, as tracks.csv has them: toe and shoulder from the discs of all balls; head and centre of
circulation from balls seen to 0.3 or more; departure and impact from true velocities. A film that does not show the
whole mill is judged by the camera and the clock alone."""
import argparse, csv, json, os, subprocess, time
from concurrent.futures import ThreadPoolExecutor
import numpy as np

ap = argparse.ArgumentParser()
ap.add_argument('dir'); ap.add_argument('--films', type=int, default=40); ap.add_argument('--seed', type=int, default=4)
ap.add_argument('--make'); ap.add_argument('--tumble'); ap.add_argument('--name', default='trial')
ap.add_argument('--jobs', type=int, default=2); ap.add_argument('--only', type=int, nargs='*', help='seeds')
ap.add_argument('--again', action='store_true', help='analyse anew what has been analysed')
ap.add_argument('--same-frames', action='store_true', help="truth of the film's own frames")
arg = ap.parse_args()
RATES = [(100, 1.2), (125, 1.0), (200, 0.7)]  # frames/s and seconds, in turn
G = 9.81
LEVELS = {'': 0.5, '_bulk': 0.75, '_outer': 0.25}
wrap = lambda d: (np.asarray(d) + 180) % 360 - 180


def made(seed):
    """The film's stem; made if it is not there."""
    stem = f'{arg.dir}/f{seed}'
    if not os.path.exists(stem + '.truth.json'):
        if not arg.make: return None
        fps, seconds = RATES[seed % 3]
        part = f'{arg.dir}/part{seed}'
        os.makedirs(part, exist_ok=True)
        subprocess.run([arg.make, 'film', '--seed', str(seed), '--level', str(seed % 4), '--seconds', str(seconds), '--fps', str(fps),
                        '--out', f'{part}/f{seed}.mp4'], check=True)
        for name in sorted(os.listdir(part)): os.rename(f'{part}/{name}', f'{arg.dir}/{name}')  # the JSON of the truth is last
        os.rmdir(part)
    return stem


def in_the_long_run(stem, t, q):
    """The same quantities; the difference between a long run and the film's frames is the simulator's own."""
    file = stem + '.mean.json'
    if not os.path.exists(file):
        if not arg.make: raise SystemExit(f'{file} is not there: give --make or --same-frames')
        frames = t['recorded_frame_of_file_frame'][-1] + 1
        subprocess.run([arg.make, 'mean', '--seed', str(t['seed']), '--level', str(t['level']), '--fps', str(t['fps_recorded']),
                        '--seconds', str((frames + 0.01) / t['fps_recorded']), '--out', file], check=True)
    mean = json.load(open(file))
    far = dict(q)
    for key, film in mean['film'].items():
        if q.get(key) is None: continue
        if film is None or mean['long'][key] is None: far[key] = np.nan; continue
        difference = mean['long'][key] - film
        far[key] = (q[key] + wrap(difference)) % 360 if key.endswith('_deg') else q[key] + difference
    return far


def analysed(stem, seed, fps):
    out = f'{stem}.{arg.name}'
    if arg.again or not os.path.exists(out + '/summary.json'):
        rate = ['--recorded-fps', str(fps)] if seed % 2 else []
        # In turns of 8 so that each level is seen with and without the rate.
        if seed // 4 % 2: rate = [] if rate else ['--recorded-fps', str(fps)]
        os.makedirs(out, exist_ok=True)
        begin = time.time()
        run = subprocess.run([arg.tumble, 'analyse', stem + '.mp4', '--mill', stem + '.given.toml', '-o', out + '/motion.h5', '--csv', out,
                              '--force', '--quiet', '--threads', '1'] + rate, capture_output=True, text=True)
        json.dump({'error': run.stderr.strip(), 'rate_given': bool(rate), 'seconds': time.time() - begin}, open(out + '/run.json', 'w'))
        if run.returncode and os.path.exists(out + '/summary.json'): os.remove(out + '/summary.json')
    return out


def occupancy(x, y, r, frames, inner, outer):
    """Share of the ring covered by discs, by degree, mean over the frames; sampled at 2 x 12 points a bin."""
    angle, rho = np.radians((np.arange(720) + 0.5) / 2), np.sqrt(np.linspace(inner**2, outer**2, 25)[:-1] + (outer**2 - inner**2) / 48)
    total, grid = np.zeros(720), np.arange(720)
    for f in frames:
        covered = np.zeros((720, 24), bool)
        for a, b, s in zip(x[f], y[f], r[f]):
            d = np.hypot(a, b)
            if d + s <= inner or d - s >= outer: continue
            half = np.arcsin(min(1, s / d)) if d > s else np.pi
            k = np.arange(int((np.arctan2(b, a) - half) * 360 / np.pi) - 1, int((np.arctan2(b, a) + half) * 360 / np.pi) + 2) % 720
            covered[k] |= d * d + rho**2 - 2 * rho * d * np.cos(angle[k] - np.arctan2(b, a))[:, None] < s * s
        total += covered.mean(1)
    return total.reshape(360, 2).mean(1) / len(frames)


def edges(o):
    """Toe and shoulder by the definition in docs/conventions.md."""
    o = (np.roll(o, 1) + o + np.roll(o, -1)) / 3
    plateau = np.percentile(o, 90)
    bulk = np.radians(np.arange(360)[o > 0.5 * plateau] + 0.5)
    start = int(np.degrees(np.angle(np.exp(1j * bulk).sum())) % 360)
    found = {}
    for suffix, share in LEVELS.items():
        for name, step in (('toe', -1), ('shoulder', 1)):
            k = start
            while o[k % 360] >= share * plateau and abs(k - start) < 360: k += step
            a, b = o[(k - step) % 360], o[k % 360]
            found[f'{name}{suffix}_deg'] = (k - step + 0.5 + step * (a - share * plateau) / max(1e-9, a - b)) % 360
    return found


def centre_of_circulation(x, y, vx, vy, r, start, reach):
    """Where a plane through the velocities nearby has its zero."""
    c = np.array(start, float)
    for _ in range(60):
        w = np.clip(1 - ((x - c[0])**2 + (y - c[1])**2) / reach**2, 0, None)**2 * r**2
        if (w > 0).sum() < 50: return [np.nan, np.nan]
        a = np.stack([np.ones_like(x), x - c[0], y - c[1]], 1)
        p = np.linalg.lstsq(a * np.sqrt(w)[:, None], np.stack([vx, vy], 1) * np.sqrt(w)[:, None], rcond=None)[0]
        move = -np.linalg.lstsq(p[1:].T, p[0], rcond=None)[0]
        far = np.hypot(*move)
        c += move * min(1, 0.3 * reach / max(far, 1e-12))
        if far < 1e-6 * reach: return list(c)
    return [np.nan, np.nan]


def flights(ball, t, x, y, vx, vy, shell, least):
    """Medians of the angles where stretches of free fall begin at the shell and where they end."""
    begin, end = [], []
    for b in np.unique(ball):
        k = np.flatnonzero(ball == b)
        k = k[np.argsort(t[k], kind='stable')]
        k = k[np.append(True, np.diff(t[k]) > 1e-9)]
        dt = np.diff(t[k])
        free = np.append(np.hypot(np.diff(vx[k]) / dt, np.diff(vy[k]) / dt + G) < 0.1 * G, False)
        i = 0
        while i < len(free):
            j = i
            while free[j]: j += 1
            p, q = k[i], k[j]
            if j > i and t[q] - t[p] >= 0.06 and i > 0 and np.hypot(x[p], y[p]) > shell and np.hypot(x[q] - x[p], y[q] - y[p]) > least:
                begin.append(np.degrees(np.arctan2(y[p], x[p])))
                if j < len(k) - 1: end.append(np.degrees(np.arctan2(y[q], x[q])))
            i = j + 1
    def median(d):
        if len(d) < 8: return np.nan
        mean = np.degrees(np.angle(np.exp(1j * np.radians(d)).sum()))
        return (mean + np.median(wrap(np.array(d) - mean))) % 360
    return median(begin), median(end)


def truth_of(stem):
    cache = stem + '.quantities.json'
    t = json.load(open(stem + '.truth.json'))
    rows = np.loadtxt(stem + '.truth.csv', delimiter=',', skiprows=1)
    frame, ball, u, v, r_px, vis, x, y, z = rows[:, :9].T
    vx, vy = rows[:, 10:12].T
    frame, ball = frame.astype(int), ball.astype(int)
    if os.path.exists(cache): return t, (frame, ball, u, v, r_px, vis), json.load(open(cache))
    radius = np.array(t['balls']['radius_m'])[ball]
    cam, mill = t['camera'], t['mill']
    eye = np.array(cam['position_m'])
    k = (eye[2] + radius) / (eye[2] - z)  # as if it touched the glass
    x, y, vx, vy = eye[0] + (x - eye[0]) * k, eye[1] + (y - eye[1]) * k, vx * k, vy * k
    if t['direction'] == 'clockwise': x, vx = -x, -vx
    R = mill['radius_m']
    tip, mean = R - mill['lifter_height_m'], 2 * np.mean(t['balls']['radius_m'])
    turn = np.radians(np.arange(0, 360, 5))
    shake = np.array(t.get('shake_px', [[0, 0]])).mean(0)
    q = {'speed_rpm': t['rpm'], 'frames_per_second': t['fps_recorded'], 'mill_centre_u_px': cam['mill_centre_px'][0] + shake[0],
         'mill_centre_v_px': cam['mill_centre_px'][1] + shake[1], 'mill_radius_px': cam['mill_radius_px'],
         'metres_per_pixel': R / cam['mill_radius_px'],
         'filling': np.sum(np.square(t['balls']['radius_m'])) / (0.82 * R**2 * mill['layers'])}
    m = np.array(cam['camera_from_mill'])
    def pixel(p):
        c = m @ (np.array(p) - eye)
        q = c[:2] / c[2]
        s = 1 + cam['k1'] * (q @ q) + cam['k2'] * (q @ q)**2
        return np.array([cam['focal_px'] * q[0] * s + cam['centre_u_px'], cam['focal_px'] * q[1] * s + cam['centre_v_px']])
    up = pixel([0, 0.01 * R, 0]) - pixel([0, -0.01 * R, 0])
    q['roll_deg'] = float(np.degrees(np.arctan2(-up[0], -up[1])))
    circle = np.array([pixel([R * np.cos(a), R * np.sin(a), 0]) for a in turn])
    whole = (circle.min(0) > 0).all() and circle[:, 0].max() < cam['width_px'] and circle[:, 1].max() < cam['height_px']
    if whole:
        order = np.argsort(frame, kind='stable')
        cut = np.split(order, np.searchsorted(frame[order], np.arange(1, frame.max() + 1)))
        q.update(edges(occupancy(x, y, radius, cut, tip - mean, tip)))
        seen = vis > 0.3
        q['head_m'] = float(np.mean([np.percentile(y[f][seen[f]], 99) for f in cut]))
        s = np.flatnonzero(seen)
        bulk = np.hypot(x[s], y[s]) < R
        c = [0, 0]
        for at in np.radians([250, 270, 290, 310, 330]):  # several starts; the right zero turns with the mill
            c = centre_of_circulation(x[s], y[s], vx[s], vy[s], radius[s], [0.6 * R * np.cos(at), 0.6 * R * np.sin(at)], 1.5 * mean)
            if np.hypot(*c) < R: break
        q['centre_of_circulation_x_m'], q['centre_of_circulation_y_m'] = c
        time = np.array(t['recorded_frame_of_file_frame'])[frame] / t['fps_recorded']
        q['departure_deg'], q['impact_toe_deg'] = flights(ball, time, x, y, vx, vy, tip - mean, 0.5 * R)
    json.dump(q, open(cache, 'w'))
    return t, (frame, ball, u, v, r_px, vis), q


def nearest(P, Q, gate, vis):
    """One to one, nearest first; the seen before the hidden."""
    if not len(P) or not len(Q): return []
    d = np.hypot(P[:, None, 0] - Q[None, :, 0], P[:, None, 1] - Q[None, :, 1])
    cost = d / gate + 0.4 * (1 - vis)
    i, j = np.nonzero(d < gate)
    order = np.argsort(cost[i, j], kind='stable')
    used_i, used_j, pairs = set(), set(), []
    for a in order:
        if i[a] in used_i or j[a] in used_j: continue
        used_i.add(i[a]); used_j.add(j[a])
        pairs.append((i[a], j[a], d[i[a], j[a]]))
    return pairs


def score_balls(out, truth):
    frame, ball, u, v, r_px, vis = truth
    rows = np.genfromtxt(out + '/tracks.csv', delimiter=',', names=True)
    f, ident, tu, tv = rows['frame'].astype(int), rows['id'].astype(int), rows['u_px'], rows['v_px']
    must_n = hit = told = false = links = links_ok = swaps = 0
    miss, last, last_must, last_of = [], {}, set(), {}
    for k in range(frame.max() + 1):
        g = np.flatnonzero((frame == k) & (vis > 0.08)); d = np.flatnonzero(f == k)
        pairs = nearest(np.stack([tu[d], tv[d]], 1), np.stack([u[g], v[g]], 1), 0.5 * r_px[g], vis[g])
        must = set(ball[g[vis[g] >= 0.6]]); of_ball = {ball[g[j]]: ident[d[i]] for i, j, _ in pairs}
        must_n += len(must); hit += len(must & of_ball.keys()); told += len(d); false += len(d) - len(pairs)
        miss += [e for i, j, e in pairs if vis[g[j]] >= 0.6]
        for b in must & last_must:
            links += 1
            links_ok += b in of_ball and of_ball[b] == last.get(b)
        of_track = {t: b for b, t in of_ball.items()}
        swaps += sum(t in last_of and last_of[t] != b for t, b in of_track.items())
        last, last_must, last_of = of_ball, must, of_track
    return hit / max(1, must_n), 1 - false / max(1, told), np.sqrt(np.mean(np.square(miss))) if miss else np.nan, links_ok / max(1, links), \
        1e3 * swaps / max(1, links_ok)


def compare(seed):
    stem = made(seed)
    if stem is None: return None
    t, balls, true = truth_of(stem)
    if not arg.same_frames: true = in_the_long_run(stem, t, true)
    true = dict(true, k1=t['camera']['k1'])
    out = analysed(stem, seed, t['fps_recorded'])
    run = json.load(open(out + '/run.json'))
    row = {'seed': seed, 'level': t['level'], 'layers': t['mill']['layers'], 'given': run['rate_given'], 'seconds': run['seconds'], 'error': run['error']}
    if not os.path.exists(out + '/summary.json'): return row
    s = json.load(open(out + '/summary.json'))
    row['recall'], row['precision'], row['px'], row['link'], row['swaps'] = score_balls(out, balls)
    row['sense'] = (s['rotation'] == 'clockwise') == (t['direction'] == 'clockwise')
    row['caveats'] = s['caveats']
    source = t['recorded_frame_of_file_frame']
    gaps = {i for i in range(len(source) - 1) if source[i + 1] > source[i] + 1}
    for name, real, said in (('dups', set(t['duplicated_file_frames']), set(s['duplicated_frames'])), ('drops', gaps, set(s['dropped_frames']))):
        row[name] = f'{len(real & said)}/{len(real)}+{len(said - real)}'
    for name, i in (('mill_centre_px', 'uv'), ('centre_of_circulation_m', 'xy')):
        for k in (0, 1):
            key = name.replace('_px', f'_{i[k]}_px').replace('_m', f'_{i[k]}_m') if i == 'xy' else name.replace('_px', f'_{i[k]}_px')
            s[key] = (s[name] or [None] * 2)[k]
            s[key + '_se'] = (s.get(name + '_se') or [None] * 2)[k]
    row['z'], row['miss'], row['values'] = {}, {}, {}
    for key, value in true.items():
        told, se = s.get(key), s.get(key + '_se')
        if value is None or np.isnan(value): continue
        if told is None: row['values'][key] = (value, None, None); continue
        e = float(wrap(told - value)) if key.endswith('_deg') else told - value
        row['miss'][key] = e if key.endswith(('_deg', 'u_px', 'v_px')) or key == 'k1' else e / t['mill']['radius_m'] if key.startswith('centre') or key == 'head_m' else e / value
        row['values'][key] = (value, told, se)
        if se is not None: row['z'][key] = e / se if se > 0 else (0.0 if abs(e) < 1e-9 * abs(value) else np.inf)
    return row


def main():
    os.makedirs(arg.dir, exist_ok=True)
    seeds = arg.only or range(arg.seed, arg.seed + arg.films)
    with ThreadPoolExecutor(arg.jobs) as pool: rows = [r for r in pool.map(compare, seeds) if r]
    json.dump(rows, open(f'{arg.dir}/{arg.name}.json', 'w'), indent=1, default=float)
    print('seed lev lay rate  recall  prec   px   link swaps  dups  drops  speed%   fps%   roll  centre  radius%    toe shoulder   75%   75%    25%    25%  s')
    for r in rows:
        head = f"{r['seed']:4} {r['level']:3} {r['layers']:3} {'yes' if r['given'] else ' no'} "
        if 'miss' not in r: print(head, r['error'][-150:]); continue
        m = r['miss'].get
        print(head + f"{r['recall']:7.3f} {r['precision']:6.3f} {r['px']:5.2f} {r['link']:5.3f} {r['swaps']:5.1f} {r['dups']:>6} {r['drops']:>6} "
              f"{100 * m('speed_rpm', np.nan):6.2f} {100 * m('frames_per_second', np.nan):6.2f} {m('roll_deg', np.nan):6.2f} "
              f"{np.hypot(m('mill_centre_u_px', np.nan), m('mill_centre_v_px', np.nan)):6.2f} {100 * m('mill_radius_px', np.nan):7.2f}  "
              + ' '.join(f"{m(n + k + '_deg', np.nan):6.1f}" for k in LEVELS for n in ('toe', 'shoulder')) + f" {r['seconds']:3.0f}" + ('' if r['sense'] else ' WRONG SENSE'))
    names = list(dict.fromkeys(k for r in rows for k in r.get('values', {})))
    print(f"\n{'quantity':28} films with_se within_2se  median|z|  median_error")
    for k in names:
        z = np.abs([r['z'][k] for r in rows if k in r.get('z', {})]); e = np.abs([r['miss'][k] for r in rows if k in r.get('miss', {})])
        print(f"{k:28} {len(e):5} {len(z):7} {100 * np.mean(z < 2) if len(z) else np.nan:9.0f} % {np.median(z) if len(z) else np.nan:10.2f} {np.median(e) if len(e) else np.nan:12.4g}")


main()
