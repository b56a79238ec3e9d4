"""Pictures that `make_films pictures` has drawn, as both trainers want them: picture, balls, coverage by balls.

Balls are rows of u, v, radius [px], visible share, size class. New pictures in the folders are taken up while training.
"""
import argparse
import glob
import json
import multiprocessing
import os
import time

import cv2
import numpy as np

LEAST_VISIBLE = 0.3  # share of its disc from which a ball counts as one to be found
GLARED = 0.8         # share under glare from which nobody is asked to find it


class Pictures:
    def __init__(self, folders, prepare):
        self.folders, self.prepare, self.known, self.items = folders, prepare, set(), []
        self.refresh()

    def refresh(self):
        for folder in self.folders:
            for path in sorted(glob.glob(os.path.join(folder, 'p*.json'))):
                if path in self.known or time.time() - os.path.getmtime(path) < 5:
                    continue
                self.known.add(path)
                item = self.prepare(*read(path[:-5]))
                if item is not None:
                    self.items.append(item)

    def any(self, rng):
        return self.items[rng.integers(len(self.items))]


def read(base):
    """Picture (BGR), balls, coverage (8 bit), and what the .json says."""
    picture = cv2.imread(base + '.jpg' if os.path.exists(base + '.jpg') else base + '.png')
    table = np.atleast_1d(np.genfromtxt(base + '.csv', delimiter=',', names=True))
    visible = table['visible'].copy()
    if 'glare' in table.dtype.names:  # as hard to find as a ball that is mostly hidden
        visible[table['glare'] > GLARED] = np.minimum(visible[table['glare'] > GLARED], 0.2)
    balls = np.stack([table['u_px'], table['v_px'], table['r_px'], visible, table['class']], 1)
    with open(base + '.json') as file:
        about = json.load(file)
    return picture, balls.astype(np.float32), cv2.imread(base + '_mask.png', 0), about


def vary(patch, rng):
    """Blur, noise, loss of colour: what the pictures have too little of."""
    if rng.random() < 0.25:
        patch = cv2.GaussianBlur(patch, (0, 0), float(rng.uniform(0.3, 0.9)))
    patch = patch.astype(np.float32)
    if rng.random() < 0.25:
        patch = patch + rng.normal(0, rng.uniform(1, 9), patch.shape)
    if rng.random() < 0.2:
        patch = np.repeat(patch.mean(2, keepdims=True), 3, 2)
    elif rng.random() < 0.4:
        patch = patch[..., rng.permutation(3)]
    return patch


def turned(rng, scale, at, size):
    """A random turn and mirroring, scaled, that brings place `at` into the middle of a square patch: 2 x 3 matrix."""
    angle, mirror = rng.uniform(0, 2 * np.pi), -1 if rng.random() < 0.5 else 1
    c, s = np.cos(angle) * scale, np.sin(angle) * scale
    m = np.array([[c * mirror, -s], [s * mirror, c]])
    return np.concatenate([m, (np.array([size / 2 - 0.5] * 2) - m @ np.asarray(at))[:, None]], 1)


def feed(make_batch, folders, prepare, seed, ahead=6):
    """A queue that another process keeps filled with batches."""
    queue = multiprocessing.Queue(ahead)

    def work():
        cv2.setNumThreads(1)
        pictures, rng, count = Pictures(folders, prepare), np.random.default_rng(seed), 0
        while True:
            queue.put((len(pictures.items), make_batch(pictures, rng)))
            count += 1
            if count % 400 == 0:
                pictures.refresh()

    multiprocessing.Process(target=work, daemon=True).start()
    return queue


def write_weights(path, convolutions):
    """For conv_net.h: weights (out, in, rows, columns), biases; channels filled up with zeros to multiples of 16."""
    def whole(n):
        return n if n < 8 else (n + 15) // 16 * 16

    with open(path + '.new', 'wb') as file:
        for c in convolutions:
            w, b = c.weight.detach().contiguous().numpy(), c.bias.detach().numpy()
            weights = np.zeros((whole(w.shape[0]), whole(w.shape[1])) + w.shape[2:], '<f4')
            biases = np.zeros(whole(w.shape[0]), '<f4')
            weights[:w.shape[0], :w.shape[1]], biases[:w.shape[0]] = w, b
            file.write(weights.tobytes() + biases.tobytes())
    os.replace(path + '.new', path)


def train(net, losses, queue, minutes, rate, save, log_every=200):
    """Adam with a warm-up and a cosine decay over the time given; `losses` returns the loss and numbers to print."""
    import torch
    optimiser, start, count, seen = torch.optim.Adam(net.parameters(), rate), time.time(), 0, []
    while True:
        done = (time.time() - start) / 60 / minutes
        if done > 1:
            break
        for group in optimiser.param_groups:
            group['lr'] = rate * min(1, count / 200 + 0.05) * 0.5 * (1 + np.cos(np.pi * done)) + 5e-6
        pictures, batch = queue.get()
        loss, numbers = losses(net, *[torch.from_numpy(b) for b in batch])
        optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(net.parameters(), 5.0)
        optimiser.step()
        seen.append(numbers)
        count += 1
        if count % log_every == 0:
            print(f'{100 * done:.0f} % of {minutes} min, {count} steps, {pictures} pictures:', np.mean(seen, 0).round(4), flush=True)
            seen = []
            save()
    save()


def main(about, new_net, make_batch, prepare, losses, minutes, ahead=6):
    """What both trainers do when they are called; `about` is their help, `minutes` how long unless told otherwise."""
    import torch
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('pictures', nargs='+')
    parser.add_argument('--minutes', type=float, default=minutes)
    parser.add_argument('--rate', type=float, default=2e-3)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--state', required=True, help='what training goes on from, where it exists, and is kept in')
    parser.add_argument('--weights', required=True)
    a = parser.parse_args()
    torch.manual_seed(a.seed)
    torch.set_num_threads(1)
    net = new_net()
    if os.path.exists(a.state):
        net.load_state_dict(torch.load(a.state))

    def save():
        torch.save(net.state_dict(), a.state)
        write_weights(a.weights, net.convolutions())

    train(net, losses, feed(make_batch, a.pictures, prepare, a.seed, ahead), a.minutes, a.rate, save)
