declare module 'virtual:published' {
  const published: import('./recording/published.ts').PublishedSource[];
  export default published;
}
