import { mount } from 'svelte';
import App from './app.svelte';
import './style.css';
import 'uplot/dist/uPlot.min.css';

mount(App, { target: document.getElementById('page') as HTMLElement });
